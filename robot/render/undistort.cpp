// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/render/undistort.hpp"

#include "common/base/check.hpp"

#include <cmath>

namespace edgesplat::render {
namespace {

void sample_bilinear(const sensor::ImageRgb8& image, const Eigen::Vector2d& at, std::uint8_t* rgb) {
  const int x = static_cast<int>(std::floor(at.x()));
  const int y = static_cast<int>(std::floor(at.y()));
  if (x < 0 || y < 0 || x + 1 >= image.width_px || y + 1 >= image.height_px) return;
  const double fx = at.x() - x;
  const double fy = at.y() - y;
  for (int c = 0; c < 3; ++c) {
    const double top = (1 - fx) * image.pixel(x, y)[c] + fx * image.pixel(x + 1, y)[c];
    const double bottom = (1 - fx) * image.pixel(x, y + 1)[c] + fx * image.pixel(x + 1, y + 1)[c];
    rgb[c] = static_cast<std::uint8_t>(std::lround((1 - fy) * top + fy * bottom));
  }
}

}  // namespace

geometry::CameraModel undistorted_model(const geometry::CameraModel& camera) {
  geometry::CameraModel pinhole = camera;
  pinhole.kind = geometry::CameraKind::kPinhole;
  pinhole.distortion = {};
  return pinhole;
}

sensor::ImageRgb8 undistort(const sensor::ImageRgb8& image, const geometry::CameraModel& camera) {
  EDGESPLAT_CHECK(image.width_px == camera.width_px && image.height_px == camera.height_px,
                  "picture of this camera");
  const bool straight =
      camera.kind == geometry::CameraKind::kPinhole && camera.distortion == decltype(camera.distortion){};
  if (straight) return image;
  sensor::ImageRgb8 out(image.width_px, image.height_px);
  for (int y = 0; y < out.height_px; ++y) {
    for (int x = 0; x < out.width_px; ++x) {
      const Eigen::Vector3d ray((x - camera.cx_px) / camera.fx_px, (y - camera.cy_px) / camera.fy_px, 1.0);
      if (const auto at = camera.project(ray)) sample_bilinear(image, *at, out.pixel(x, y));
    }
  }
  return out;
}

}  // namespace edgesplat::render
