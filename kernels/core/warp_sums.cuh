// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/host_device.hpp"
#include "kernels/core/launch.cuh"

namespace edgesplat::core {

/// Sum over the warp, in a fixed order; every lane gets it. All lanes must take part.
template <typename T>
__device__ inline T warp_sum(T value) {
  for (unsigned step = kWarp / 2; step > 0; step /= 2) value += __shfl_xor_sync(kAllLanes, value, step);
  return value;
}

/// One step of warp_sums: half of `values` goes to the lane `kHalf` further, the other half's comes.
template <int kHalf>
__device__ inline void fold_half(float* values, unsigned lane) {
  const bool upper = (lane & kHalf) != 0;
  EDGESPLAT_UNROLL
  for (int i = 0; i < kHalf; ++i) {
    const float mine = upper ? values[i + kHalf] : values[i];
    const float other = upper ? values[i] : values[i + kHalf];
    values[i] = mine + __shfl_xor_sync(kAllLanes, other, kHalf);
  }
}

/// Sums of 16 values over the warp at once: lane l returns that of values[l % 16]. 16 exchanges instead of
/// the 80 of sum after sum; always in the same order. All lanes must take part; `values` is used up.
__device__ inline float warp_sums16(float* values, unsigned lane) {
  fold_half<8>(values, lane);
  fold_half<4>(values, lane);
  fold_half<2>(values, lane);
  fold_half<1>(values, lane);
  return values[0] + __shfl_xor_sync(kAllLanes, values[0], kWarp / 2);
}

/// Sum over a block of kThreads, in a fixed order; thread 0 gets it. All threads must take part.
template <unsigned kThreads, typename T>
__device__ inline T block_sum(T value) {
  __shared__ T by_warp[kThreads / kWarp];
  value = warp_sum(value);
  __syncthreads();  // what an earlier call left has been read
  if (threadIdx.x % kWarp == 0) by_warp[threadIdx.x / kWarp] = value;
  __syncthreads();
  T sum{};
  if (threadIdx.x == 0) {
    for (unsigned w = 0; w < kThreads / kWarp; ++w) sum += by_warp[w];
  }
  return sum;
}

}  // namespace edgesplat::core
