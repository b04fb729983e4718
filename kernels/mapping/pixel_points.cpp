// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/pixel_points.hpp"

#include <algorithm>

namespace edgesplat::mapping {

std::vector<map::ColouredPoint> points_of(std::span<const PixelDepth> pixels, const StoredView& view,
                                          const geometry::RigidTransform& map_from_body) {
  const geometry::RigidTransform body_from_camera = map_from_body.inverse() * view.map_from_camera;
  const Eigen::Matrix3f rotation = body_from_camera.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = body_from_camera.translation_m.cast<float>();
  std::vector<map::ColouredPoint> points;
  points.reserve(pixels.size());
  for (const PixelDepth& pixel : pixels) {
    map::ColouredPoint point;
    point.p_in_body_m = rotation * (pixel.depth_m * ray_of(view.camera(), pixel.x, pixel.y)) + translation;
    const std::uint8_t* rgb = view.picture.pixel(pixel.x, pixel.y);
    std::copy(rgb, rgb + 3, point.rgb.begin());
    point.has_colour = true;
    points.push_back(point);
  }
  return points;
}

}  // namespace edgesplat::mapping
