// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/render/draw_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace edgesplat::render {
namespace {

/// Red, yellow, green, cyan, blue over 0..1.
std::array<std::uint8_t, 3> depth_colour(double share) {
  const double hue = 4.0 * std::clamp(share, 0.0, 1.0);  // sixths of the colour circle, red to blue
  const auto channel = [hue](double peak) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(2.0 - std::abs(hue - peak), 0.0, 1.0)));
  };
  return {channel(0.0), channel(2.0), channel(4.0)};
}

}  // namespace

void draw_points_by_depth(std::span<const map::ColouredPoint> points_in_body,
                          const geometry::RigidTransform& camera_from_body,
                          const geometry::CameraModel& camera, double max_range_m, sensor::ImageRgb8& image) {
  struct Mark {
    int x, y;
    double z_m;
  };
  std::vector<Mark> marks;
  for (const map::ColouredPoint& p : points_in_body) {
    const Eigen::Vector3d p_in_camera = camera_from_body * p.p_in_body_m.cast<double>();
    const auto pixel = camera.project(p_in_camera);
    if (!pixel || !camera.contains(*pixel)) continue;
    marks.push_back({static_cast<int>(std::lround(pixel->x())), static_cast<int>(std::lround(pixel->y())),
                     p_in_camera.norm()});
  }
  std::sort(marks.begin(), marks.end(), [](const Mark& a, const Mark& b) { return a.z_m > b.z_m; });
  for (const Mark& mark : marks) {
    const auto colour = depth_colour(std::sqrt(mark.z_m / max_range_m));
    for (int y = mark.y; y <= std::min(mark.y + 1, image.height_px - 1); ++y) {
      for (int x = mark.x; x <= std::min(mark.x + 1, image.width_px - 1); ++x) {
        if (x >= 0 && y >= 0) std::copy(colour.begin(), colour.end(), image.pixel(x, y));
      }
    }
  }
}

}  // namespace edgesplat::render
