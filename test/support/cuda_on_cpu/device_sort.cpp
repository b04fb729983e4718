// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Stands in for kernels/core/device_sort.cu, which is CUB.
#include "kernels/core/device_sort.cuh"

#include <algorithm>
#include <numeric>
#include <vector>

namespace edgesplat::core {

Status DeviceSort::sort(const Stream&, const SortPairs& pairs, int bits) {
  const std::uint32_t kept = bits >= 32 ? ~0U : (1U << static_cast<unsigned>(bits)) - 1U;
  std::vector<std::uint32_t> order(pairs.count);
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return (pairs.keys[a] & kept) < (pairs.keys[b] & kept);
  });
  for (std::size_t i = 0; i < pairs.count; ++i) {
    pairs.keys_sorted[i] = pairs.keys[order[i]];
    pairs.values_sorted[i] = pairs.values[order[i]];
  }
  return {};
}

Status DeviceSort::exclusive_sum(const Stream&, const std::uint32_t* from, std::uint32_t* to,
                                 std::size_t count) {
  std::exclusive_scan(from, from + count, to, 0U);
  return {};
}

}  // namespace edgesplat::core
