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

/// A splat as the pixels ask it: opacity times falloff = 2^(top - (a dx^2 + b dx dy + c dy^2)).
struct Falloff {
  float a, b, c;
  float top;
};

[[gnu::always_inline]] inline Falloff falloff_of(const Splat& s) {
  constexpr float kLog2e = 1.44269504F;
  constexpr float kLog2Of255 = 7.99435344F;
  // reach2 = 2 ln(255 opacity)
  return {0.5F * kLog2e * s.conic[0], kLog2e * s.conic[1], 0.5F * kLog2e * s.conic[2],
          0.5F * kLog2e * s.reach2 - kLog2Of255};
}

/// Opacity times falloff, before it is cut at kMaxAlpha and dropped under kMinAlpha.
[[gnu::always_inline]] inline float raw_alpha(const Falloff& f, float dx, float dy) {
  const float along_x = std::fma(f.b, dy, f.a * dx);
  const float form = std::fma(along_x, dx, f.c * dy * dy);
  return exp2_fast(std::max(std::min(f.top - form, f.top), -20.0F));
}

/// Alpha as blended: the forward and the backward pass must take the same decisions to the last bit.
[[gnu::always_inline]] inline float blended_alpha(float raw) {
  const float cut = std::min(raw, kMaxAlpha);
  return cut < kMinAlpha ? 0.0F : cut;
}

/// A tile's splats lie all over memory: asked for this many ahead, they are there in time.
inline constexpr std::size_t kPrefetchAhead = 6;

}  // namespace edgesplat::splat
