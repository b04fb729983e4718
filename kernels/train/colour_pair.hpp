// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace edgesplat::train {

/// A drawn picture beside the one it should be. sRGB, rows of 3 floats a pixel.
struct ColourPair {
  int width_px = 0;
  int height_px = 0;
  std::span<const float> drawn;   ///< [H,W,3]
  std::span<const float> target;  ///< [H,W,3]
  std::span<const float> weight;  ///< [H,W] 0..1, how much a pixel counts; empty: all of them fully

  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  }
  [[nodiscard]] bool consistent() const {
    return width_px > 0 && height_px > 0 && drawn.size() == 3 * pixels() && target.size() == 3 * pixels() &&
           (weight.empty() || weight.size() == pixels());
  }
  /// What losses are divided by: the pixels that count.
  [[nodiscard]] double total_weight() const {
    if (weight.empty()) return static_cast<double>(pixels());
    double sum = 0.0;
    for (const float w : weight) sum += static_cast<double>(w);
    return sum;
  }
};

}  // namespace edgesplat::train
