// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/train/colour_pair.hpp"

#include <span>

namespace edgesplat::train {

/// Structural similarity (Wang 2004), window 11x11 Gaussian of sigma 1.5, C1 = 0.01^2, C2 = 0.03^2, per
/// channel, zeros beyond the picture's edge, mean over all pixels: as 3DGS computes it. With weights both
/// pictures are multiplied by them first, so that what does not count does not reach its neighbours either,
/// and the mean is weighted. 0 where no pixel counts. Deterministic whatever the number of threads. Pairs
/// must be consistent.
[[nodiscard]] double ssim(const ColourPair& pair);

struct SsimAndL1 {
  double ssim = 0.0;
  double l1 = 0.0;  ///< weighted mean absolute difference
};

/// Both measures in one pass over the pictures; writes `ssim_factor` times the gradient of the similarity by
/// the drawn picture plus `l1_factor` times that of the absolute difference into `by_drawn` [H,W,3]. Zeros
/// where no pixel counts.
SsimAndL1 ssim_l1_backward(const ColourPair& pair, float ssim_factor, float l1_factor,
                           std::span<float> by_drawn);

}  // namespace edgesplat::train
