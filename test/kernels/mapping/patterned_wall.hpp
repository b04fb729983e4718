// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/mapping/stored_view.hpp"

#include <cmath>
#include <cstdint>
#include <memory>

namespace edgesplat::mapping::patterned_wall {

inline constexpr int kWidth_px = 160, kHeight_px = 96;
inline constexpr double kWall_m = 8.0;

inline geometry::CameraModel camera() {
  return {geometry::CameraKind::kPinhole, kWidth_px, kHeight_px, 120.0, 120.0, 79.5, 47.5, {}};
}

/// Detail at several scales, 0..1.
inline double pattern(double x, double y) {
  return 0.5 + 0.16 * (std::sin(9.0 * x + 3.0 * y) + std::sin(23.0 * y - 5.0 * x) + std::sin(4.0 * x * y));
}

/// A wall across the way with a pattern, seen by a camera that looks along z, standing at `position_m`. Over
/// `blank_above_m` (y is down) nothing but grey is seen.
inline StoredView seen_from(const Eigen::Vector3d& position_m, double blank_above_m = -1e9) {
  StoredView view;
  view.undistorter = std::make_shared<image::Undistorter>(camera());
  view.map_from_camera.translation_m = position_m;
  view.picture = sensor::ImageRgb8(kWidth_px, kHeight_px);
  for (int y = 0; y < kHeight_px; ++y) {
    for (int x = 0; x < kWidth_px; ++x) {
      const double depth_m = kWall_m - position_m.z();
      const double wall_x = position_m.x() + depth_m * (x - camera().cx_px) / camera().fx_px;
      const double wall_y = position_m.y() + depth_m * (y - camera().cy_px) / camera().fy_px;
      const double value = wall_y < blank_above_m ? 0.8 : pattern(wall_x, wall_y);
      for (int c = 0; c < 3; ++c)
        view.picture.pixel(x, y)[c] = static_cast<std::uint8_t>(std::lround(255.0 * value));
    }
  }
  return view;
}

}  // namespace edgesplat::mapping::patterned_wall
