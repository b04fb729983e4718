// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/image/undistort.hpp"

#include "common/base/check.hpp"

#include <cmath>
#include <cstddef>

namespace edgesplat::image {
namespace {

bool is_straight(const geometry::CameraModel& camera) {
  return camera.kind == geometry::CameraKind::kPinhole && camera.distortion == decltype(camera.distortion){};
}

}  // namespace

geometry::CameraModel undistorted_model(const geometry::CameraModel& camera) {
  geometry::CameraModel pinhole = camera;
  pinhole.kind = geometry::CameraKind::kPinhole;
  pinhole.distortion = {};
  return pinhole;
}

Undistorter::Undistorter(const geometry::CameraModel& camera)
    : model_(undistorted_model(camera)),
      seen_(static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px), 1.0F) {
  if (is_straight(camera)) return;
  places_.resize(seen_.size());
  std::size_t pixel = 0;
  for (int y = 0; y < model_.height_px; ++y) {
    for (int x = 0; x < model_.width_px; ++x, ++pixel) {
      const Eigen::Vector3d ray((x - camera.cx_px) / camera.fx_px, (y - camera.cy_px) / camera.fy_px, 1.0);
      const auto at = camera.project(ray);
      const bool inside = at && at->x() >= 0.0 && at->y() >= 0.0 && at->x() < camera.width_px - 1 &&
                          at->y() < camera.height_px - 1;
      if (inside) {
        places_[pixel] = {static_cast<float>(at->x()), static_cast<float>(at->y())};
      } else {
        seen_[pixel] = 0.0F;
      }
    }
  }
}

sensor::ImageRgb8 Undistorter::apply(const sensor::ImageRgb8& picture) const {
  EDGESPLAT_CHECK(picture.width_px == model_.width_px && picture.height_px == model_.height_px,
                  "picture of this camera");
  if (places_.empty()) return picture;
  sensor::ImageRgb8 out(picture.width_px, picture.height_px);
  std::uint8_t* rgb = out.values.data();
  for (std::size_t pixel = 0; pixel < places_.size(); ++pixel, rgb += 3) {
    if (seen_[pixel] == 0.0F) continue;
    const auto x = static_cast<int>(places_[pixel].x);
    const auto y = static_cast<int>(places_[pixel].y);
    const float fx = places_[pixel].x - static_cast<float>(x);
    const float fy = places_[pixel].y - static_cast<float>(y);
    const std::uint8_t* top = picture.pixel(x, y);
    const std::uint8_t* bottom = picture.pixel(x, y + 1);
    for (std::size_t c = 0; c < 3; ++c) {
      const float above = (1 - fx) * top[c] + fx * top[c + 3];
      const float below = (1 - fx) * bottom[c] + fx * bottom[c + 3];
      // Never negative, and lround is a call. NOLINTNEXTLINE(bugprone-incorrect-roundings)
      rgb[c] = static_cast<std::uint8_t>((1 - fy) * above + fy * below + 0.5F);
    }
  }
  return out;
}

}  // namespace edgesplat::image
