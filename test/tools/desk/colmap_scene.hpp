// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/camera_set.hpp"
#include "common/io/colmap_model.hpp"
#include "test/common/io/colmap_samples.hpp"

#include <gtest/gtest.h>

namespace edgesplat::desk {

/// A nerfstudio scene's cameras and points as COLMAP has them: one OPENCV camera an image, images numbered
/// from behind. Its images must be PNGs in images/.
inline io::ColmapSample colmap_of(const std::filesystem::path& scene) {
  const auto set = io::read_camera_set(scene / "transforms.json").value();
  io::ColmapSample sample;
  for (const io::PosedCamera& posed : set.cameras) {
    const geometry::CameraModel& c = posed.camera;
    const auto id = static_cast<std::uint32_t>(set.cameras.size() - sample.cameras.size());
    sample.cameras.push_back({id,
                              4,
                              "OPENCV",
                              static_cast<std::uint64_t>(c.width_px),
                              static_cast<std::uint64_t>(c.height_px),
                              {c.fx_px, c.fy_px, c.cx_px + 0.5, c.cy_px + 0.5, c.distortion[0],
                               c.distortion[1], c.distortion[2], c.distortion[3]}});
    sample.images.push_back({id, posed.map_from_camera.inverse(), id, posed.image.filename().string(), 3});
  }
  if (!set.points.empty()) sample.points = io::read_points(scene / set.points).value();
  return sample;
}

}  // namespace edgesplat::desk
