// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/device_buffer.cuh"

#include <cstddef>
#include <cstdint>

namespace edgesplat::core {

/// Keys with a value each on the device, and room for them sorted.
struct SortPairs {
  const std::uint32_t* keys;     // [N] u32
  const std::uint32_t* values;   // [N] u32
  std::uint32_t* keys_sorted;    // [N] u32
  std::uint32_t* values_sorted;  // [N] u32
  std::size_t count;
};

/// Sorts and sums of whole arrays on the device. Keeps its working memory from call to call. Deterministic.
/// Single-owner.
class DeviceSort {
 public:
  explicit DeviceSort(VramPool& pool) : working_(pool, "sorting") {}
  /// Ascending by the lowest `bits` of the keys; equal ones keep their order. kOutOfVram.
  [[nodiscard]] Status sort(const Stream& stream, const SortPairs& pairs, int bits);
  /// to[i] = sum of from[0..i). kOutOfVram.
  [[nodiscard]] Status exclusive_sum(const Stream& stream, const std::uint32_t* from, std::uint32_t* to,
                                     std::size_t count);

 private:
  DeviceBuffer<unsigned char> working_;
};

}  // namespace edgesplat::core
