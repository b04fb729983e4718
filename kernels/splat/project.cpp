// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/project.hpp"

#include "kernels/splat/project_backends.hpp"

namespace edgesplat::splat {

Result<Projected> project(core::Backend backend, const GaussianSpans& gaussians, const View& view,
                          const RenderOptions& options) {
  if (!gaussians.consistent()) {
    return fail(Errc::kInvalidArgument, "Gaussian arrays of different lengths, or an SH degree outside 0..3");
  }
  if (backend == core::Backend::kCpu) return project_cpu(gaussians, view, options);
#ifdef EDGESPLAT_WITH_CUDA
  return project_cuda(gaussians, view, options);
#else
  return fail(Errc::kUnavailable, "this build has no CUDA backend: configure with the preset cuda");
#endif
}

}  // namespace edgesplat::splat
