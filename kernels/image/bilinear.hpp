// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/image.hpp"

#include <cstdint>

namespace edgesplat::image {

/// The value at (x + right, y + down) with right, down in [0, 1). Precondition: the pixels (x, y) and (x + 1,
/// y + 1) are in the picture.
[[nodiscard]] inline float bilinear(const sensor::ImageGray8& picture, int x, int y, float right,
                                    float down) {
  const std::uint8_t* top = picture.pixel(x, y);
  const std::uint8_t* bottom = top + picture.width_px;
  const auto a = static_cast<float>(top[0]), b = static_cast<float>(top[1]);
  const auto c = static_cast<float>(bottom[0]), d = static_cast<float>(bottom[1]);
  const float above = a + right * (b - a);
  const float below = c + right * (d - c);
  return above + down * (below - above);
}

}  // namespace edgesplat::image
