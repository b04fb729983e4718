// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/image.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::sensor {

/// The picture's values as 0..1 into `out` [H,W,3], which is resized.
inline void to_unit_floats(const ImageRgb8& picture, std::vector<float>& out) {
  out.resize(picture.values.size());
  std::transform(picture.values.begin(), picture.values.end(), out.begin(),
                 [](std::uint8_t value) { return static_cast<float>(value) / 255.0F; });
}

/// The reverse, cut to 0..1 and rounded. `colour` has 3 * width_px * height_px values.
[[nodiscard]] inline ImageRgb8 to_rgb8(std::span<const float> colour, int width_px, int height_px) {
  ImageRgb8 picture(width_px, height_px);
  std::transform(colour.begin(), colour.end(), picture.values.begin(), [](float value) {
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F)));
  });
  return picture;
}

}  // namespace edgesplat::sensor
