// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/blend.hpp"

#include <cstddef>
#include <cstdint>
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

/// What one picture says about one splat: dL by what the blend read of it, and what the way back to its
/// Gaussian needs.
struct alignas(64) SplatBackward {
  float by_u, by_v;        ///< per px
  float by_conic[3];       ///< xx, xy counted once, yy
  float by_log_opacity;    ///< of the opacity as drawn
  float by_rgb[3];         ///< 0 where the colour was cut at 0
  float by_depth;          ///< per m
  float conic[3];          ///< as drawn
  float radius_px;         ///< larger half of its box
  float weight;            ///< sum of its blending weights: how many pixels it fills
  std::uint32_t gaussian;  ///< row
};

/// What one tile says about one splat: a line of cache of sums.
struct alignas(64) TileSums {
  float sums[16];
};

/// Memory that one call of blend_backward leaves for the next: tens of megabytes, whose pages cost more than
/// the sums.
struct BlendBackwardScratch {
  std::vector<TileSums> by_slot;
  std::vector<SplatBackward> by_row;
};

struct BlendGradients {
  std::span<const SplatBackward> by_row;  ///< one a splat, in the order of rows (Splat::order)
  std::size_t seen = 0;                   ///< those with a weight: the others are hidden
};

/// Reverse of splat::blend: gradients of every splat, valid until `scratch` is used again. Goes front to back
/// like the forward pass and takes what lies behind a splat as what is left of the pixel's total, so that it
/// needs the pictures and no record of the forward pass. Each tile leaves its sums in slots of its own, which
/// are added in the order of tiles: the result does not depend on the number of threads. Lengths must match
/// the view (checked as bugs).
[[nodiscard]] BlendGradients blend_backward(std::span<const splat::Splat> splats,
                                            const splat::TileLists& tiles, const splat::View& view,
                                            const Pictures& drawn, const PictureGradients& by_picture,
                                            BlendBackwardScratch& scratch);

}  // namespace edgesplat::train
