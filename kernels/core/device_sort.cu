// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/device_sort.cuh"

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

namespace edgesplat::core {

Status DeviceSort::sort(const Stream& stream, const SortPairs& pairs, int bits) {
  if (pairs.count == 0) return {};
  const auto run = [&](void* working, std::size_t& bytes) {
    return cub::DeviceRadixSort::SortPairs(working, bytes, pairs.keys, pairs.keys_sorted, pairs.values,
                                           pairs.values_sorted, pairs.count, 0, bits, stream.get());
  };
  std::size_t bytes = 0;
  EDGESPLAT_CUDA_TRY(run(nullptr, bytes));
  EDGESPLAT_TRY_STATUS(working_.reserve(bytes));
  EDGESPLAT_CUDA_TRY(run(working_.data(), bytes));
  return {};
}

Status DeviceSort::exclusive_sum(const Stream& stream, const std::uint32_t* from, std::uint32_t* to,
                                 std::size_t count) {
  if (count == 0) return {};
  std::size_t bytes = 0;
  EDGESPLAT_CUDA_TRY(cub::DeviceScan::ExclusiveSum(nullptr, bytes, from, to, count, stream.get()));
  EDGESPLAT_TRY_STATUS(working_.reserve(bytes));
  EDGESPLAT_CUDA_TRY(cub::DeviceScan::ExclusiveSum(working_.data(), bytes, from, to, count, stream.get()));
  return {};
}

}  // namespace edgesplat::core
