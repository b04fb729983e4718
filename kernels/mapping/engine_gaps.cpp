// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Seeding where the LiDAR does not look.
#include "kernels/mapping/engine.hpp"
#include "kernels/splat/render.hpp"

#include <algorithm>

namespace edgesplat::mapping {
namespace {

/// Pixels of the view that the map has something for now are trained on.
void mark_mapped(std::span<const PixelDepth> swept, std::span<const float> alpha, const SweepOptions& options,
                 StoredView& view) {
  if (view.unmapped.empty()) return;
  const auto width = static_cast<std::size_t>(view.camera().width_px);
  for (std::size_t pixel = 0; pixel < alpha.size(); ++pixel) {
    if (alpha[pixel] >= options.max_alpha) view.unmapped[pixel] = false;
  }
  // A point stands for the pixels around it.
  const int before = options.stride_px / 2;
  for (const PixelDepth& d : swept) {
    const int right = std::min(view.camera().width_px, d.x - before + options.stride_px);
    const int bottom = std::min(view.camera().height_px, d.y - before + options.stride_px);
    for (int y = std::max(0, d.y - before); y < bottom; ++y) {
      for (int x = std::max(0, d.x - before); x < right; ++x)
        view.unmapped[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] = false;
    }
  }
}

}  // namespace

Result<std::vector<float>> MappingEngine::draw_alpha(const StoredView& view,
                                                     const gaussian::GaussianCloud& cloud,
                                                     std::span<const float> others) {
  EDGESPLAT_TRY(const splat::View drawn_from,
                splat::View::from(view.camera(), view.map_from_camera.inverse()));
  const std::size_t pixels = view.undistorter->seen().size();
  colour_.resize(3 * pixels);
  depth_m_.resize(pixels);
  std::vector<float> alpha(pixels);
  EDGESPLAT_TRY(const splat::RenderStats stats, splat::render(core::Backend::kCpu, splat::spans_of(cloud),
                                                              drawn_from, {}, {colour_, depth_m_, alpha}));
  (void)stats;
  for (std::size_t pixel = 0; pixel < others.size(); ++pixel)
    alpha[pixel] = 1.0F - (1.0F - alpha[pixel]) * (1.0F - others[pixel]);
  return alpha;
}

Result<std::size_t> MappingEngine::fill_floor(const StoredView& view, const SeedInput& seeded,
                                              std::span<const float> others) {
  EDGESPLAT_TRY(const std::vector<float> alpha, draw_alpha(view, cloud(), others));
  const auto points = fill_holes(view, seeded.map_from_body, *ground_, alpha, options_.fill);
  SeedInput holes = seeded;
  holes.points_in_body = points;
  return seed(holes);
}

Result<std::size_t> MappingEngine::fill_by_sweep(StoredView& view, const SeedInput& seeded,
                                                 std::span<const float> others) {
  std::vector<const StoredView*> newest_first;
  for (const StoredView& other : views_.views()) newest_first.push_back(&other);
  std::reverse(newest_first.begin(), newest_first.end());
  const auto partners = sweep_partners(view, newest_first, options_.sweep);
  if (partners.empty()) return std::size_t{0};
  EDGESPLAT_TRY(const std::vector<float> alpha, draw_alpha(view, cloud(), others));
  const auto swept = sweep_depths(view, partners, ground_ ? &*ground_ : nullptr, alpha, options_.sweep);
  mark_mapped(swept, alpha, options_.sweep, view);
  const auto points = points_of(swept, view, seeded.map_from_body);
  SeedInput gaps = seeded;
  gaps.points_in_body = points;
  gaps.spacing_rad = static_cast<float>(options_.sweep.stride_px / view.camera().fx_px);
  return seed(gaps);
}

}  // namespace edgesplat::mapping
