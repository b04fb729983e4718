// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/support/cuda_on_cpu/cuda_runtime.h"

#include <cstdlib>

/// What streams point to here.
struct CUstream_st {
  int unused;
};

const char* cudaGetErrorString(cudaError_t code) {
  switch (code) {
    case cudaSuccess:
      return "no error";
    case cudaErrorMemoryAllocation:
      return "out of memory";
    default:
      return "invalid argument or launch";
  }
}

cudaError_t cudaGetDeviceCount(int* count) {
  *count = 1;
  return cudaSuccess;
}

cudaError_t cudaMalloc(void** first, std::size_t bytes) {
  *first = std::malloc(bytes);
  if (*first == nullptr) return cudaErrorMemoryAllocation;
  std::memset(*first, 0xFF, bytes);  // NaN, and no index that is one
  return cudaSuccess;
}

cudaError_t cudaFree(void* first) {
  std::free(first);
  return cudaSuccess;
}

cudaError_t cudaMemGetInfo(std::size_t* free_bytes, std::size_t* total_bytes) {
  *free_bytes = *total_bytes = std::size_t{1} << 32U;
  return cudaSuccess;
}

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned) {
  *stream = new CUstream_st{};
  return cudaSuccess;
}

cudaError_t cudaStreamDestroy(cudaStream_t stream) {
  delete stream;
  return cudaSuccess;
}

cudaError_t cudaStreamSynchronize(cudaStream_t) {
  return cudaSuccess;
}

cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind,
                            cudaStream_t stream) {
  if (stream == nullptr) return cudaErrorInvalidValue;
  std::memcpy(to, from, bytes);
  return cudaSuccess;
}

cudaError_t cudaMemsetAsync(void* first, int byte, std::size_t bytes, cudaStream_t stream) {
  if (stream == nullptr) return cudaErrorInvalidValue;
  std::memset(first, byte, bytes);
  return cudaSuccess;
}
