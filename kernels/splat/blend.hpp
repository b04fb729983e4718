// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/tile_lists.hpp"

#include <span>

namespace edgesplat::splat {

/// Pictures that the caller owns, row-major.
struct BlendOutputs {
  std::span<float> colour;       ///< [H,W,3] sRGB, background included
  std::span<float> depth_sum_m;  ///< [H,W] sum of weight times depth; divide by alpha for the expected depth
  std::span<float> alpha;        ///< [H,W] sum of weights, 0..1
};

/// Largest alpha one splat may have in a pixel (3DGS).
inline constexpr float kMaxAlpha = 0.99F;
/// A pixel takes no further splat that would leave less than this transmittance (3DGS).
inline constexpr float kMinTransmittance = 1e-4F;

/// Front-to-back alpha blending of each tile's splats: alpha = min(0.99, opacity exp(-d^2/2)), skipped under
/// 1/255. Tiles are independent, so the result does not depend on the number of threads.
void blend(std::span<const Splat> splats, const TileLists& tiles, const View& view,
           const RenderOptions& options, const BlendOutputs& out);

}  // namespace edgesplat::splat
