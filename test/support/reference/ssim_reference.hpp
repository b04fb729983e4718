// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace edgesplat::test {

/// Structural similarity written down plainly: every window whole (11x11, sigma 1.5, zeros beyond the edge),
/// double precision, variances from their definition. Pictures [H,W,3]; weights [H,W] multiply both and the
/// mean.
[[nodiscard]] double reference_ssim(int width_px, int height_px, const std::vector<double>& x,
                                    const std::vector<double>& y, const std::vector<double>& weight);

}  // namespace edgesplat::test
