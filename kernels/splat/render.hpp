// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/blend.hpp"

namespace edgesplat::splat {

struct RenderStats {
  std::size_t visible = 0;
  std::size_t tile_pairs = 0;
  std::uint64_t not_finite = 0;  ///< Gaussians skipped because a parameter is NaN or infinite
};

/// Memory that one picture leaves for the next.
struct RenderScratch {
  ProjectScratch project;
  Projected projected;
  TileListsScratch tiles_scratch;
  TileLists tiles;
};

/// Draws Gaussians: project, sort, tile, blend (3D Gaussian Splatting, Kerbl 2023). Outputs are written
/// whole; an empty cloud gives the background. Errors: kInvalidArgument (lengths), kUnavailable (backend).
/// Thread-safe for different `scratch`.
[[nodiscard]] Result<RenderStats> render(core::Backend backend, const GaussianSpans& gaussians,
                                         const View& view, const RenderOptions& options,
                                         const BlendOutputs& out, RenderScratch& scratch);
/// The same for once.
[[nodiscard]] Result<RenderStats> render(core::Backend backend, const GaussianSpans& gaussians,
                                         const View& view, const RenderOptions& options,
                                         const BlendOutputs& out);

}  // namespace edgesplat::splat
