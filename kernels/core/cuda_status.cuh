// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <cuda_runtime.h>

#include <string>

namespace edgesplat::core {

/// A CUDA runtime error as an Error: kOutOfVram, kUnavailable (no device or driver) or kIo.
[[nodiscard]] inline Status cuda_status(cudaError_t code, const char* call) {
  if (code == cudaSuccess) return {};
  Errc errc = Errc::kIo;
  if (code == cudaErrorMemoryAllocation) errc = Errc::kOutOfVram;
  if (code == cudaErrorNoDevice || code == cudaErrorInsufficientDriver ||
      code == cudaErrorNoKernelImageForDevice)
    errc = Errc::kUnavailable;
  return fail(errc, std::string(call) + ": " + cudaGetErrorString(code));
}

}  // namespace edgesplat::core

/// `EDGESPLAT_CUDA_TRY(cudaMemcpyAsync(...));` returns the call's error from the function.
#define EDGESPLAT_CUDA_TRY(call) EDGESPLAT_TRY_STATUS(::edgesplat::core::cuda_status((call), #call))
