// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/image/gray_pyramid.hpp"

#include "common/base/check.hpp"
#include "kernels/image/gray_rows.hpp"

#include <cstddef>
#include <cstdint>

namespace edgesplat::image {
namespace {

void resize(sensor::ImageGray8& image, int width_px, int height_px) {
  image.width_px = width_px;
  image.height_px = height_px;
  image.values.resize(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
}

void to_gray(const sensor::ImageRgb8& picture, sensor::ImageGray8& gray) {
  resize(gray, picture.width_px, picture.height_px);
  gray_row(picture.values.data(), gray.values.data(), gray.values.size());
}

/// to_gray() and halve() in one pass.
void to_half_gray(const sensor::ImageRgb8& picture, sensor::ImageGray8& gray) {
  resize(gray, picture.width_px / 2, picture.height_px / 2);
  const auto count = static_cast<std::size_t>(gray.width_px);
  for (int y = 0; y < gray.height_px; ++y)
    half_gray_row(picture.pixel(0, 2 * y), picture.pixel(0, 2 * y + 1), gray.pixel(0, y), count);
}

void halve(const sensor::ImageGray8& image, sensor::ImageGray8& half) {
  resize(half, image.width_px / 2, image.height_px / 2);
  const auto count = static_cast<std::size_t>(half.width_px);
  for (int y = 0; y < half.height_px; ++y)
    half_row(image.pixel(0, 2 * y), image.pixel(0, 2 * y + 1), half.pixel(0, y), count);
}

}  // namespace

void GrayPyramid::build(const sensor::ImageRgb8& picture, int skip, int levels) {
  EDGESPLAT_CHECK(skip >= 0 && skip <= 4 && levels >= 1, "a pyramid has a level");
  EDGESPLAT_CHECK(std::min(picture.width_px, picture.height_px) >> (skip + levels) > 0,
                  "room for its levels");
  levels_.resize(static_cast<std::size_t>(levels));
  if (skip == 0) {
    to_gray(picture, levels_[0]);
  } else {
    to_half_gray(picture, levels_[0]);
  }
  for (int i = 1; i < skip; ++i) {
    sensor::ImageGray8 half;
    halve(levels_[0], half);
    levels_[0] = std::move(half);
  }
  for (std::size_t l = 1; l < levels_.size(); ++l) halve(levels_[l - 1], levels_[l]);
}

geometry::CameraModel halved(const geometry::CameraModel& camera, int times) {
  geometry::CameraModel half = camera;
  for (int i = 0; i < times; ++i) {
    half.width_px /= 2;
    half.height_px /= 2;
    half.fx_px /= 2.0;
    half.fy_px /= 2.0;
    half.cx_px = (half.cx_px + 0.5) / 2.0 - 0.5;  // pixel centres lie at whole numbers
    half.cy_px = (half.cy_px + 0.5) / 2.0 - 0.5;
  }
  return half;
}

}  // namespace edgesplat::image
