// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/backend.hpp"

#include "kernels/core/cuda_probe.hpp"

#include <string>

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

#ifndef EDGESPLAT_WITH_CUDA
Status probe_cuda() {
  return fail(Errc::kUnavailable, "this build has no CUDA backend: configure with the preset cuda");
}
#endif

std::vector<Backend> available_backends() {
  if (probe_cuda()) return {Backend::kCpu, Backend::kCuda};
  return {Backend::kCpu};
}

Result<Backend> choose_backend(std::string_view name) {
  if (name == "cpu") return Backend::kCpu;
  if (name == "auto") return available_backends().back();
  if (name != "cuda")
    return fail(Errc::kInvalidConfig, "unknown backend \"" + std::string(name) + "\": use auto, cpu or cuda");
  EDGESPLAT_TRY_STATUS(probe_cuda());
  return Backend::kCuda;
}

}  // namespace edgesplat::core
