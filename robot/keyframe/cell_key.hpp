// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <optional>

namespace edgesplat::keyframe {

/// Packs the grid cell of a point into 3 x 21 bits, mixed so that neighbours spread over a hash table;
/// nothing for a point that is not finite or lies beyond 2^20 cells of the origin.
inline std::optional<std::uint64_t> cell_key(const Eigen::Vector3f& p_m, float cell_m) {
  constexpr float kHalfRange = 1048576.0F;
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float cell = std::floor(p_m[axis] / cell_m);
    if (!(std::abs(cell) < kHalfRange)) return std::nullopt;
    key = (key << 21U) | static_cast<std::uint64_t>(static_cast<std::int64_t>(cell) + 1048576);
  }
  return key * 0x9E3779B97F4A7C15ULL;  // odd multiplier: a bijection, so still one key a cell
}

}  // namespace edgesplat::keyframe
