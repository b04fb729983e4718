// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/device_buffer.cuh"
#include "test/kernels/core/copy_rate.hpp"

#include <algorithm>

namespace edgesplat::core {

Result<double> copy_rate_bytes_per_s(const Stream& stream, VramPool& pool) {
  constexpr std::size_t kBytes = std::size_t{256} << 20U;
  constexpr int kCopies = 10;
  DeviceBuffer<unsigned char> from(pool, "the copy's source"), to(pool, "the copy");
  EDGESPLAT_TRY_STATUS(from.reserve(kBytes));
  EDGESPLAT_TRY_STATUS(to.reserve(kBytes));
  cudaEvent_t before = nullptr, after = nullptr;
  EDGESPLAT_CUDA_TRY(cudaEventCreate(&before));
  EDGESPLAT_CUDA_TRY(cudaEventCreate(&after));
  float best_ms = 1e9F;
  for (int i = 0; i < kCopies; ++i) {
    EDGESPLAT_CUDA_TRY(cudaEventRecord(before, stream.get()));
    EDGESPLAT_CUDA_TRY(
        cudaMemcpyAsync(to.data(), from.data(), kBytes, cudaMemcpyDeviceToDevice, stream.get()));
    EDGESPLAT_CUDA_TRY(cudaEventRecord(after, stream.get()));
    EDGESPLAT_TRY_STATUS(stream.synchronise());
    float took_ms = 0.0F;
    EDGESPLAT_CUDA_TRY(cudaEventElapsedTime(&took_ms, before, after));
    best_ms = std::min(best_ms, took_ms);
  }
  cudaEventDestroy(before);
  cudaEventDestroy(after);
  return 2.0 * static_cast<double>(kBytes) / (static_cast<double>(best_ms) * 1e-3);
}

Result<std::string> device_name() {
  cudaDeviceProp properties{};
  EDGESPLAT_CUDA_TRY(cudaGetDeviceProperties(&properties, 0));
  return std::string(properties.name) + ", sm_" + std::to_string(properties.major) +
         std::to_string(properties.minor);
}

}  // namespace edgesplat::core
