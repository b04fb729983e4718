// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/simd_variants.hpp"
#include "kernels/splat/project.hpp"
#include "kernels/splat/tile_lists.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace edgesplat::splat {

/// A tile as 16 blocks of 4x4 pixels, each a vector of 16: a splat of a few pixels touches fewer blocks than
/// rows.
inline constexpr int kBlockPx = 4;
inline constexpr int kBlocks = 16;
inline constexpr int kBlockPixels = 16;
static_assert(kTilePx == 4 * kBlockPx);

/// One quantity of every pixel of a tile.
using TilePlane = float[kBlocks][kBlockPixels];

/// Place of a pixel of a tile, x and y in 0..15.
[[gnu::always_inline]] inline int block_of(int x, int y) {
  return y / kBlockPx * kBlockPx + x / kBlockPx;
}
[[gnu::always_inline]] inline int pixel_of(int x, int y) {
  return y % kBlockPx * kBlockPx + x % kBlockPx;
}

inline constexpr float kPixelX[kBlockPixels] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
inline constexpr float kPixelY[kBlockPixels] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

/// Bit b is set where alpha may reach 1/255 in block b of the tile whose top-left pixel is (x0, y0): smallest
/// value of the splat's quadratic form over the block's pixel centres. It is convex, so its minimum over a
/// rectangle lies at the point nearest to the centre in x or in y, the other coordinate being free.
EDGESPLAT_INLINE std::uint32_t blocks_reached(const Splat& s, float x0, float y0) {
  constexpr auto kSpan = static_cast<float>(kBlockPx - 1);
  const float a = s.conic[0], b = s.conic[1], c = s.conic[2];
  const float slope_y = -b / c, slope_x = -b / a;
  // A hair more than the blend's own threshold, so that rounding never loses a pixel.
  const float reach2 = s.reach2 * 1.0001F + 1e-4F;
  const float left = x0 - s.u_px, top = y0 - s.v_px;
  std::uint32_t bits[kBlocks];
  for (int k = 0; k < kBlocks; ++k) {
    const float x_low = left + 4.0F * kPixelX[k], x_high = x_low + kSpan;
    const float y_low = top + 4.0F * kPixelY[k], y_high = y_low + kSpan;
    const float x = std::min(std::max(0.0F, x_low), x_high);
    const float y = std::min(std::max(0.0F, y_low), y_high);
    const float y_of_x = std::min(std::max(slope_y * x, y_low), y_high);
    const float x_of_y = std::min(std::max(slope_x * y, x_low), x_high);
    const float at_x = a * x * x + (2.0F * b * x + c * y_of_x) * y_of_x;
    const float at_y = c * y * y + (2.0F * b * y + a * x_of_y) * x_of_y;
    // What is not a number counts as reached.
    bits[k] = std::min(at_x, at_y) > reach2 ? 0U : 1U << static_cast<unsigned>(k);
  }
  std::uint32_t reached = 0;
  for (const std::uint32_t bit : bits) reached |= bit;
  return reached;
}

/// Bit b is set where some pixel of block b still takes splats: those have a transmittance above 0.
EDGESPLAT_INLINE std::uint32_t blocks_active(const TilePlane& transmittance) {
  std::uint32_t blocks = 0;
  for (unsigned b = 0; b < kBlocks; ++b) {
    std::uint32_t any = 0;
    for (std::size_t i = 0; i < kBlockPixels; ++i) any |= transmittance[b][i] > 0.0F ? 1U : 0U;
    blocks |= any << b;
  }
  return blocks;
}

}  // namespace edgesplat::splat
