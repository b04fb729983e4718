// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/blend.hpp"
#include "kernels/train/splat_gradient.hpp"

#include <span>
#include <vector>

namespace edgesplat::train {

/// What splat::blend drew.
struct Pictures {
  std::span<const float> colour;       ///< [H,W,3]
  std::span<const float> depth_sum_m;  ///< [H,W]
  std::span<const float> alpha;        ///< [H,W]
};

/// dL by each value of the pictures. `depth_sum` and `alpha` may be empty: zero.
struct PictureGradients {
  std::span<const float> colour;     ///< [H,W,3]
  std::span<const float> depth_sum;  ///< [H,W] per m
  std::span<const float> alpha;      ///< [H,W]
};

/// What one picture says about one splat.
struct SplatBackward {
  SplatGradient<float> gradient;
  float weight;  ///< sum of its blending weights: how many pixels it fills
};

/// What one tile says about one splat: a line of cache of sums.
struct alignas(64) TileSums {
  float sums[16];
};

/// Memory that one call of blend_backward leaves for the next: tens of megabytes, whose pages cost more than
/// the sums.
struct BlendBackwardScratch {
  std::vector<TileSums> by_slot;
  std::vector<SplatBackward> by_splat;
};

/// Reverse of splat::blend: gradients of every splat, in the order of `splats`, valid until `scratch` is used
/// again. Goes front to back like the forward pass and takes what lies behind a splat as what is left of the
/// pixel's total, so that it needs the pictures and no record of the forward pass. Each tile leaves its sums
/// in slots of its own, which are added in the order of tiles: the result does not depend on the number of
/// threads. Lengths must match the view (checked as bugs).
[[nodiscard]] std::span<const SplatBackward> blend_backward(std::span<const splat::Splat> splats,
                                                            const splat::TileLists& tiles,
                                                            const splat::View& view, const Pictures& drawn,
                                                            const PictureGradients& by_picture,
                                                            BlendBackwardScratch& scratch);

}  // namespace edgesplat::train
