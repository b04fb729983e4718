// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/train/colour_pair.hpp"

#include <span>

namespace edgesplat::train {

struct ColourLoss {
  double value = 0.0;
  double l1 = 0.0;    ///< mean absolute difference
  double ssim = 0.0;  ///< mean similarity; not computed (0) where its share is 0
};

/// (1 - share) L1 + share (1 - SSIM) (3DGS, eq. 7, D-SSIM not halved, as its code has it), weighted mean over
/// pixels and channels. Writes its gradient by the drawn picture into `by_drawn` [H,W,3]. Both 0 where no
/// pixel counts. Pairs must be consistent. Deterministic.
ColourLoss colour_loss(const ColourPair& pair, float ssim_share, std::span<float> by_drawn);

struct DepthPair {
  std::span<const float> depth_sum_m;  ///< [H,W] as drawn
  std::span<const float> alpha;        ///< [H,W] as drawn
  std::span<const float> target_m;     ///< [H,W] measured depth along z; 0 (or not finite): none
  std::span<const float> weight;       ///< [H,W] 0..1; empty: all fully
};

/// Mean over the measured pixels of |depth_sum / alpha - target|, metres, times `factor`; pixels that are
/// covered by less than `min_alpha` are left out, their depth being up to noise. Writes `by_depth_sum` and
/// `by_alpha` [H,W] whole. Returns the mean in metres before `factor`. Deterministic.
double depth_loss(const DepthPair& pair, float factor, float min_alpha, std::span<float> by_depth_sum,
                  std::span<float> by_alpha);

/// What is left open where the world has something everywhere: the mean of 1 - alpha [H,W] over the weighted
/// pixels. Adds `factor` times its slope to `by_alpha` [H,W]; returns the mean before `factor`. `weight`:
/// empty: every pixel counts. Deterministic.
double add_gap_loss(std::span<const float> alpha, std::span<const float> weight, float factor,
                    std::span<float> by_alpha);

}  // namespace edgesplat::train
