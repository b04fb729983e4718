// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/span2d.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgesplat::sensor {

/// A picture that owns its pixels, row-major, `Channels` interleaved values a pixel.
template <typename T, int Channels>
struct Image {
  static constexpr int kChannels = Channels;
  int width_px = 0;
  int height_px = 0;
  std::vector<T> values;  ///< [height, width, Channels]

  Image() = default;
  Image(int width, int height, T fill = T{})
      : width_px(width),
        height_px(height),
        values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * Channels, fill) {}

  [[nodiscard]] bool empty() const { return values.empty(); }
  [[nodiscard]] T* pixel(int x, int y) { return values.data() + offset(x, y); }
  [[nodiscard]] const T* pixel(int x, int y) const { return values.data() + offset(x, y); }

 private:
  [[nodiscard]] std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x)) *
           Channels;
  }
};

using ImageRgb8 = Image<std::uint8_t, 3>;  ///< sRGB
using ImageGray8 = Image<std::uint8_t, 1>;
using ImageGray16 = Image<std::uint16_t, 1>;  ///< e.g. depth in mm
using ImageRgbF32 = Image<float, 3>;          ///< 0..1
using ImageF32 = Image<float, 1>;             ///< e.g. depth in m, 0 = none

}  // namespace edgesplat::sensor
