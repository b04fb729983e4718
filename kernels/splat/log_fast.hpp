// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace edgesplat::splat {

/// ln(x) of normal positive numbers, absolute error under 2e-7 + 1e-7 |ln x|, exact at 1; no branches and no
/// table, so that loops vectorise. The exponent, and the series of the inverse hyperbolic tangent for what is
/// left in [sqrt(1/2), sqrt(2)).
[[gnu::always_inline]] inline float log_fast(float x) {
  constexpr std::int32_t kRootHalf = 0x3f3504f3;
  const std::int32_t bits = std::bit_cast<std::int32_t>(x) - kRootHalf;
  const std::int32_t exponent = bits >> 23;
  const float m = std::bit_cast<float>((bits & 0x007fffff) + kRootHalf);
  const float s = (m - 1.0F) / (m + 1.0F);
  const float s2 = s * s;
  float p = std::fma(s2, 0.2222222222F, 0.2857142857F);
  p = std::fma(p, s2, 0.4F);
  p = std::fma(p, s2, 0.6666666667F);
  const float series = std::fma(p * s2, s, s + s);
  return std::fma(static_cast<float>(exponent), 0.6931471806F, series);
}

}  // namespace edgesplat::splat
