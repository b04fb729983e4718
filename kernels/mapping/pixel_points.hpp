// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/mapping/stored_view.hpp"

#include <span>
#include <vector>

namespace edgesplat::mapping {

/// A pixel of a view and how far away what it shows is taken to be.
struct PixelDepth {
  int x, y;
  float depth_m;  ///< z in the camera frame
};

/// Through the pixel's centre, with z = 1, in the camera frame.
[[nodiscard]] inline Eigen::Vector3f ray_of(const geometry::CameraModel& pinhole, int x, int y) {
  return {static_cast<float>((x - pinhole.cx_px) / pinhole.fx_px),
          static_cast<float>((y - pinhole.cy_px) / pinhole.fy_px), 1.0F};
}

/// The pixels as points of their picture's colour, in the body frame at the view's pose.
[[nodiscard]] std::vector<map::ColouredPoint> points_of(std::span<const PixelDepth> pixels,
                                                        const StoredView& view,
                                                        const geometry::RigidTransform& map_from_body);

}  // namespace edgesplat::mapping
