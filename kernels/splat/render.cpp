// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/render.hpp"

namespace edgesplat::splat {

Result<RenderStats> render(core::Backend backend, const GaussianSpans& gaussians, const View& view,
                           const RenderOptions& options, const BlendOutputs& out, RenderScratch& scratch) {
  const auto pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
  if (out.colour.size() != 3 * pixels || out.depth_sum_m.size() != pixels || out.alpha.size() != pixels) {
    return fail(Errc::kInvalidArgument, "the output pictures do not have the view's size");
  }
  Projected& projected = scratch.projected;
  EDGESPLAT_TRY_STATUS(project(backend, gaussians, view, options, scratch.project, projected));
  make_tile_lists(projected.splats, view.width_px, view.height_px, scratch.tiles_scratch, scratch.tiles);
  blend(projected.splats, scratch.tiles, view, options, out);
  return RenderStats{projected.splats.size(), scratch.tiles.entries.size(), projected.not_finite};
}

Result<RenderStats> render(core::Backend backend, const GaussianSpans& gaussians, const View& view,
                           const RenderOptions& options, const BlendOutputs& out) {
  RenderScratch scratch;
  return render(backend, gaussians, view, options, out, scratch);
}

}  // namespace edgesplat::splat
