// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/project.hpp"

#include "kernels/splat/project_backends.hpp"

namespace edgesplat::splat {

Status project(core::Backend backend, const GaussianSpans& gaussians, const View& view,
               const RenderOptions& options, ProjectScratch& scratch, Projected& out) {
  if (!gaussians.consistent()) {
    return fail(Errc::kInvalidArgument, "Gaussian arrays of different lengths, or an SH degree outside 0..3");
  }
  if (backend == core::Backend::kCpu) {
    project_cpu(gaussians, view, options, scratch, out);
    return {};
  }
#ifdef EDGESPLAT_WITH_CUDA
  EDGESPLAT_TRY(out, project_cuda(gaussians, view, options));
  return {};
#else
  return fail(Errc::kUnavailable, "this build has no CUDA backend: configure with the preset cuda");
#endif
}

Result<Projected> project(core::Backend backend, const GaussianSpans& gaussians, const View& view,
                          const RenderOptions& options) {
  ProjectScratch scratch;
  Projected out;
  EDGESPLAT_TRY_STATUS(project(backend, gaussians, view, options, scratch, out));
  return out;
}

}  // namespace edgesplat::splat
