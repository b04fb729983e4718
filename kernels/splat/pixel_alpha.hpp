// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/blend.hpp"
#include "kernels/splat/exp_fast.hpp"
#include "kernels/splat/splat_one.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace edgesplat::splat {

/// One splat on one row of pixels: power(dx) = -(a dx^2 + b dx + c), so that only dx is left to do per pixel.
struct RowOfSplat {
  float a, b, c;
};

[[gnu::always_inline]] inline RowOfSplat row_of(const Splat& s, float dy) {
  return {0.5F * s.conic[0], s.conic[1] * dy, 0.5F * s.conic[2] * dy * dy};
}

/// Opacity times falloff, before it is cut at kMaxAlpha and dropped under kMinAlpha.
[[gnu::always_inline]] inline float raw_alpha(float opacity, const RowOfSplat& row, float dx) {
  const float power = -(row.a * dx * dx + row.b * dx + row.c);
  return opacity * exp_fast(std::max(std::min(power, 0.0F), -20.0F));
}

/// Alpha as blended: the forward and the backward pass must take the same decisions to the last bit.
[[gnu::always_inline]] inline float blended_alpha(float raw) {
  const float cut = std::min(raw, kMaxAlpha);
  return cut < kMinAlpha ? 0.0F : cut;
}

/// A tile's splats lie all over memory: asked for this many ahead, they are there in time.
inline constexpr std::size_t kPrefetchAhead = 6;
[[gnu::always_inline]] inline void prefetch(const Splat& s) {
  __builtin_prefetch(&s);
  __builtin_prefetch(&s.gaussian);  // it may lie across two lines
}

struct TileRows {
  int first, last;  ///< both inclusive; empty where last < first
};

/// The rows of a tile, counted from its top at y0, that a splat's box reaches.
[[gnu::always_inline]] inline TileRows rows_reached(const Splat& s, float y0) {
  constexpr auto kRows = static_cast<float>(kTilePx);
  // Clamped as floats: a splat may be larger than any int.
  return {static_cast<int>(std::clamp(std::ceil(s.v_px - s.half_height_px - y0), 0.0F, kRows)),
          static_cast<int>(std::clamp(std::floor(s.v_px + s.half_height_px - y0), -1.0F, kRows - 1))};
}

}  // namespace edgesplat::splat
