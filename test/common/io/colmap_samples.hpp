// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/io/ply_points.hpp"
#include "test/support/temp_dir.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::io {

/// A reconstruction as COLMAP writes it, after its documentation (https://colmap.github.io/format.html).
struct ColmapSample {
  struct Camera {
    std::uint32_t id;
    std::int32_t model;
    std::string model_name;
    std::uint64_t width_px, height_px;
    std::vector<double> parameters;
  };
  struct Image {
    std::uint32_t id;
    geometry::RigidTransform camera_from_map;
    std::uint32_t camera;
    std::string name;
    std::size_t features;
  };
  std::vector<Camera> cameras;
  std::vector<Image> images;
  PointCloud points;

  [[nodiscard]] std::vector<std::byte> cameras_bin() const;
  [[nodiscard]] std::string cameras_txt() const;
  [[nodiscard]] std::vector<std::byte> images_bin() const;
  [[nodiscard]] std::string images_txt() const;
  [[nodiscard]] std::vector<std::byte> points_bin() const;
  [[nodiscard]] std::string points_txt() const;
  /// All three files into FOLDER/`model`/.
  void write_bin(const test::TempDir& folder, const std::string& model) const;
  void write_txt(const test::TempDir& folder, const std::string& model) const;
};

/// Two cameras, three images whose names are not in the order of their numbers, four points.
[[nodiscard]] ColmapSample colmap_sample();

}  // namespace edgesplat::io
