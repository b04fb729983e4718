// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/backend.hpp"

namespace edgesplat::core {

std::string_view to_string(Backend backend) {
  return backend == Backend::kCpu ? "cpu" : "cuda";
}

bool built_with_cuda() {
#ifdef EDGESPLAT_WITH_CUDA
  return true;
#else
  return false;
#endif
}

}  // namespace edgesplat::core
