// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/image/undistort.hpp"

#include "common/base/check.hpp"

#include <cmath>
#include <cstddef>

namespace edgesplat::image {
namespace {

bool is_straight(const geometry::CameraModel& camera) {
  return camera.kind == geometry::CameraKind::kPinhole && !camera.has_distortion();
}

std::size_t pixels_of(const geometry::CameraModel& camera) {
  return static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
}

geometry::CameraModel shrunk_model(const geometry::CameraModel& camera, int shrink) {
  geometry::CameraModel small = camera;
  small.width_px /= shrink;
  small.height_px /= shrink;
  small.fx_px /= shrink;
  small.fy_px /= shrink;
  small.cx_px = (camera.cx_px + 0.5) / shrink - 0.5;  // pixel centres lie at whole numbers
  small.cy_px = (camera.cy_px + 0.5) / shrink - 0.5;
  return small;
}

sensor::ImageRgb8 shrink_picture(const sensor::ImageRgb8& picture, int shrink) {
  sensor::ImageRgb8 out(picture.width_px / shrink, picture.height_px / shrink);
  const auto share = static_cast<std::uint32_t>(shrink * shrink);
  for (int y = 0; y < out.height_px; ++y) {
    for (int x = 0; x < out.width_px; ++x) {
      std::uint32_t sum[3] = {};
      for (int v = y * shrink; v < (y + 1) * shrink; ++v) {
        const std::uint8_t* rgb = picture.pixel(x * shrink, v);
        for (int i = 0; i < 3 * shrink; ++i) sum[i % 3] += rgb[i];
      }
      for (int c = 0; c < 3; ++c)
        out.pixel(x, y)[c] = static_cast<std::uint8_t>((sum[c] + share / 2) / share);
    }
  }
  return out;
}

}  // namespace

geometry::CameraModel undistorted_model(const geometry::CameraModel& camera) {
  geometry::CameraModel pinhole = camera;
  pinhole.kind = geometry::CameraKind::kPinhole;
  pinhole.distortion = {};
  pinhole.k3 = 0.0;
  return pinhole;
}

Undistorter::Undistorter(const geometry::CameraModel& camera, int shrink)
    : full_(undistorted_model(camera)),
      model_(shrunk_model(full_, shrink)),
      shrink_(shrink),
      seen_(pixels_of(model_), 1.0F) {
  if (is_straight(camera)) return;
  places_.resize(pixels_of(full_));
  std::size_t pixel = 0;
  for (int y = 0; y < full_.height_px; ++y) {
    for (int x = 0; x < full_.width_px; ++x, ++pixel) {
      const Eigen::Vector3d ray((x - camera.cx_px) / camera.fx_px, (y - camera.cy_px) / camera.fy_px, 1.0);
      const auto at = camera.project(ray);
      const bool inside = at && at->x() >= 0.0 && at->y() >= 0.0 && at->x() < camera.width_px - 1 &&
                          at->y() < camera.height_px - 1;
      places_[pixel] = inside ? Place{static_cast<float>(at->x()), static_cast<float>(at->y())} : kNowhere;
      const int small_x = x / shrink;
      const int small_y = y / shrink;
      if (inside || small_x >= model_.width_px || small_y >= model_.height_px) continue;
      seen_[static_cast<std::size_t>(small_y) * static_cast<std::size_t>(model_.width_px) +
            static_cast<std::size_t>(small_x)] = 0.0F;
    }
  }
}

sensor::ImageRgb8 Undistorter::apply(const sensor::ImageRgb8& picture) const {
  EDGESPLAT_CHECK(fits(picture), "picture of this camera");
  if (shrink_ == 1) return places_.empty() ? picture : resample(picture);
  return shrink_picture(places_.empty() ? picture : resample(picture), shrink_);
}

sensor::ImageRgb8 Undistorter::resample(const sensor::ImageRgb8& picture) const {
  sensor::ImageRgb8 out(picture.width_px, picture.height_px);
  std::uint8_t* rgb = out.values.data();
  for (std::size_t pixel = 0; pixel < places_.size(); ++pixel, rgb += 3) {
    if (places_[pixel].x < 0.0F) continue;
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
