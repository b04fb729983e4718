// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/project.hpp"

namespace edgesplat::splat {

/// One implementation a backend; inputs are checked by project().
void project_cpu(const GaussianSpans& gaussians, const View& view, const RenderOptions& options,
                 ProjectScratch& scratch, Projected& out);
[[nodiscard]] Result<Projected> project_cuda(const GaussianSpans& gaussians, const View& view,
                                             const RenderOptions& options);

}  // namespace edgesplat::splat
