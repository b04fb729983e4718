// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Stands in for NVIDIA's header of this name, so that a C++ compiler builds the project's .cu files and
/// tests run their kernels on the CPU: as much of the runtime and of the device functions as kernels/ uses,
/// no more. Every thread of a block is a fiber, see block_runner.hpp. "Device" memory is the host's, filled
/// with NaN when it is taken. Streams do everything at once.

#include "test/support/cuda_on_cpu/block_runner.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <tuple>
#include <utility>

#define __global__
#define __device__
#define __host__
#define __forceinline__ inline
#define __launch_bounds__(...)
#define __restrict__
/// Blocks run one after the other on one thread of the CPU.
#define __shared__ static

enum cudaError_t {
  cudaSuccess = 0,
  cudaErrorInvalidValue = 1,
  cudaErrorMemoryAllocation = 2,
  cudaErrorInvalidConfiguration = 9,
  cudaErrorInsufficientDriver = 35,
  cudaErrorNoDevice = 100,
  cudaErrorNoKernelImageForDevice = 209,
};
using cudaStream_t = struct CUstream_st*;
enum cudaMemcpyKind { cudaMemcpyHostToDevice, cudaMemcpyDeviceToHost, cudaMemcpyDeviceToDevice };
inline constexpr unsigned cudaStreamNonBlocking = 1;

const char* cudaGetErrorString(cudaError_t code);
cudaError_t cudaGetDeviceCount(int* count);
cudaError_t cudaMalloc(void** first, std::size_t bytes);
cudaError_t cudaFree(void* first);
cudaError_t cudaMemGetInfo(std::size_t* free_bytes, std::size_t* total_bytes);
cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned flags);
cudaError_t cudaStreamDestroy(cudaStream_t stream);
cudaError_t cudaStreamSynchronize(cudaStream_t stream);
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind,
                            cudaStream_t stream);
cudaError_t cudaMemsetAsync(void* first, int byte, std::size_t bytes, cudaStream_t stream);

struct dim3 {
  unsigned x = 1, y = 1, z = 1;
  constexpr dim3(unsigned x_ = 1, unsigned y_ = 1, unsigned z_ = 1) : x(x_), y(y_), z(z_) {}
};
struct cudaLaunchConfig_t {
  dim3 gridDim, blockDim;
  std::size_t dynamicSmemBytes;
  cudaStream_t stream;
};

template <typename... Parameters, typename... Arguments>
cudaError_t cudaLaunchKernelEx(const cudaLaunchConfig_t* config, void (*kernel)(Parameters...),
                               Arguments&&... arguments) {
  const auto& grid = config->gridDim;
  const auto& block = config->blockDim;
  const bool flat = grid.y == 1 && grid.z == 1 && block.y == 1 && block.z == 1;
  // Threads must be whole warps here: what the kernels of this project use, and what the fibers know.
  if (!flat || config->stream == nullptr || grid.x == 0 || block.x == 0 || block.x > 1024 ||
      block.x % 32 != 0)
    return cudaErrorInvalidConfiguration;
  const std::tuple<Parameters...> copies(std::forward<Arguments>(arguments)...);
  edgesplat::test::run_blocks(grid.x, block.x, [&] { std::apply(kernel, copies); });
  return cudaSuccess;
}

inline void __syncthreads() {
  edgesplat::test::block_barrier(false);
}
inline int __syncthreads_and(int predicate) {
  return edgesplat::test::block_barrier(predicate == 0) == 0 ? 1 : 0;
}
inline int __syncthreads_or(int predicate) {
  return edgesplat::test::block_barrier(predicate != 0) != 0 ? 1 : 0;
}
inline void __syncwarp(unsigned mask = 0xFFFFFFFFU) {
  edgesplat::test::warp_exchange(mask, 0);
}
inline unsigned __ballot_sync(unsigned mask, int predicate) {
  const auto& all = edgesplat::test::warp_exchange(mask, predicate != 0 ? 1 : 0);
  unsigned ballot = 0;
  for (unsigned lane = 0; lane < 32; ++lane) {
    if ((mask >> lane & 1U) != 0 && all[lane] != 0) ballot |= 1U << lane;
  }
  return ballot;
}
inline int __any_sync(unsigned mask, int predicate) {
  return __ballot_sync(mask, predicate) != 0 ? 1 : 0;
}
inline int __all_sync(unsigned mask, int predicate) {
  return __ballot_sync(mask, predicate) == mask ? 1 : 0;
}
template <typename T>
T emulated_shuffle(unsigned mask, T value, unsigned from_lane) {
  static_assert(sizeof(T) <= sizeof(std::uint64_t));
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof(T));
  const auto& all = edgesplat::test::warp_exchange(mask, bits);
  T result;
  std::memcpy(&result, &all[from_lane & 31U], sizeof(T));
  return result;
}
template <typename T>
T __shfl_xor_sync(unsigned mask, T value, unsigned lane_mask) {
  return emulated_shuffle(mask, value, threadIdx.x % 32 ^ lane_mask);
}
template <typename T>
T __shfl_sync(unsigned mask, T value, unsigned lane, unsigned width = 32) {
  return emulated_shuffle(mask, value, threadIdx.x % 32 / width * width + lane % width);
}
template <typename T>
T atomicAdd(T* to, T value) {
  const T before = *to;
  *to = before + value;
  return before;
}
inline int __popc(unsigned bits) {
  return __builtin_popcount(bits);
}
inline int __ffs(unsigned bits) {
  return __builtin_ffs(static_cast<int>(bits));
}
inline unsigned __float_as_uint(float value) {
  unsigned bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}
