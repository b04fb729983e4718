// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/cuda_status.cuh"
#include "kernels/core/vram_pool.hpp"

#include <algorithm>

namespace edgesplat::core {
namespace {

std::string mebibytes(std::size_t bytes) {
  return std::to_string((bytes + (std::size_t{1} << 20U) - 1) >> 20U) + " MiB";
}

}  // namespace

Result<void*> VramPool::take(std::size_t bytes, std::string_view purpose) {
  if (bytes == 0) return nullptr;
  if (bytes > budget_bytes_ - used_bytes_) {
    return fail(Errc::kOutOfVram, "no room on the GPU for " + std::string(purpose) + ": " + mebibytes(bytes) +
                                      " asked, " + mebibytes(used_bytes_) + " of " +
                                      mebibytes(budget_bytes_) +
                                      " used. Take fewer Gaussians or more budget");
  }
  void* first = nullptr;
  EDGESPLAT_CUDA_TRY(cudaMalloc(&first, bytes));
  used_bytes_ += bytes;
  peak_bytes_ = std::max(peak_bytes_, used_bytes_);
  return first;
}

void VramPool::give_back(void* first, std::size_t bytes) {
  if (first == nullptr) return;
  cudaFree(first);  // waits for kernels that still use it
  used_bytes_ -= bytes;
}

Result<std::size_t> share_of_free_vram(double share) {
  std::size_t free_bytes = 0, total_bytes = 0;
  EDGESPLAT_CUDA_TRY(cudaMemGetInfo(&free_bytes, &total_bytes));
  return static_cast<std::size_t>(share * static_cast<double>(free_bytes));
}

}  // namespace edgesplat::core
