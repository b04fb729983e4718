// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/render.hpp"

namespace edgesplat::splat {

Result<RenderStats> render(core::Backend backend, const GaussianSpans& gaussians, const View& view,
                           const RenderOptions& options, const BlendOutputs& out) {
  const auto pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
  if (out.colour.size() != 3 * pixels || out.depth_sum_m.size() != pixels || out.alpha.size() != pixels) {
    return fail(Errc::kInvalidArgument, "the output pictures do not have the view's size");
  }
  EDGESPLAT_TRY(const Projected projected, project(backend, gaussians, view, options));
  const TileLists tiles = make_tile_lists(projected.splats, view.width_px, view.height_px);
  blend(projected.splats, tiles, view, options, out);
  return RenderStats{projected.splats.size(), tiles.entries.size(), projected.not_finite};
}

}  // namespace edgesplat::splat
