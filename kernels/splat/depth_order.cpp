// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/depth_order.hpp"

#include <tbb/parallel_sort.h>

#include <bit>
#include <cstdint>

namespace edgesplat::splat {

std::vector<Splat> sorted_by_depth(const std::vector<Splat>& splats) {
  // 64-bit keys: positive floats sort as their bits do, and the row below them breaks ties.
  std::vector<std::uint64_t> keys(splats.size());
  for (std::size_t i = 0; i < splats.size(); ++i) {
    keys[i] = static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(splats[i].depth_m)) << 32U | i;
  }
  tbb::parallel_sort(keys.begin(), keys.end());
  std::vector<Splat> sorted(splats.size());
  for (std::size_t i = 0; i < keys.size(); ++i) sorted[i] = splats[keys[i] & 0xFFFFFFFFU];
  return sorted;
}

}  // namespace edgesplat::splat
