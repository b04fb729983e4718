// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace edgesplat::splat {

/// 2^x for x in [-100, 100], relative error under 7e-7, exact at 0; no branches and no table, so that loops
/// over pixels vectorise. 2^n times the minimax polynomial of the remainder in [-0.5, 0.5]. Fused
/// multiply-adds are written out, so that every machine computes the same.
[[gnu::always_inline]] inline float exp2_fast(float x) {
  const float shifted = x + 12582912.0F;  // 1.5 * 2^23: rounds to the nearest integer in the low bits
  const float f = x - (shifted - 12582912.0F);
  float p = std::fma(0.0011125509F, f, 0.0096662825F);
  p = std::fma(p, f, 0.0555740047F);
  p = std::fma(p, f, 0.2402235065F);
  p = std::fma(p, f, 0.6931428306F);
  p = std::fma(p, f, 1.0F);
  const auto exponent = std::bit_cast<std::int32_t>(shifted) << 23;
  return std::bit_cast<float>(std::bit_cast<std::int32_t>(p) + exponent);
}

}  // namespace edgesplat::splat
