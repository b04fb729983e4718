// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/cuda_probe.hpp"
#include "kernels/core/cuda_status.cuh"

namespace edgesplat::core {

Status probe_cuda() {
  int count = 0;
  EDGESPLAT_CUDA_TRY(cudaGetDeviceCount(&count));
  if (count == 0) return fail(Errc::kUnavailable, "the CUDA driver finds no device: check nvidia-smi");
  return {};
}

}  // namespace edgesplat::core
