// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace edgesplat::pointcloud {

/// A cell of a cubic grid as one number: 21 bits an axis, floor division (cell -1 is [-edge, 0)). Wraps after
/// a million cells along an axis.
using VoxelKey = std::uint64_t;

[[nodiscard]] inline VoxelKey voxel_key(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::uint64_t kMask = (1U << 21U) - 1U;
  return ((static_cast<std::uint64_t>(x) & kMask) << 42U) | ((static_cast<std::uint64_t>(y) & kMask) << 21U) |
         (static_cast<std::uint64_t>(z) & kMask);
}

/// floor() for numbers that fit 64 bits; without SSE4.1 the library call costs more than the rest of a
/// look-up.
template <typename Real>
[[nodiscard]] std::int64_t floor_to_cell(Real value) {
  const auto truncated = static_cast<std::int64_t>(value);
  return truncated - (static_cast<Real>(truncated) > value ? 1 : 0);
}

/// Mixes all bits of a key (the finaliser of splitmix64) for tables with a power of two of slots.
[[nodiscard]] inline std::size_t hash_key(VoxelKey key) {
  key = (key ^ (key >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  key = (key ^ (key >> 27U)) * 0x94d049bb133111ebULL;
  return static_cast<std::size_t>(key ^ (key >> 31U));
}

}  // namespace edgesplat::pointcloud
