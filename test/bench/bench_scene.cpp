// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/bench/bench_scene.hpp"

#include "kernels/splat/tile_blocks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace edgesplat::bench {

namespace {

/// Geometric mean of the two sigmas of the ellipse without the low-pass, in the median.
double median_sigma(const std::vector<splat::Splat>& splats, float low_pass_px2) {
  if (splats.empty()) return 0.0;
  std::vector<double> sigmas_px;
  for (const splat::Splat& s : splats) {
    const double xx = s.conic[0], xy = s.conic[1], yy = s.conic[2], det = xx * yy - xy * xy;
    const double own_xx = yy / det - static_cast<double>(low_pass_px2);
    const double own_yy = xx / det - static_cast<double>(low_pass_px2);
    sigmas_px.push_back(std::pow(std::max(own_xx * own_yy - xy * xy / (det * det), 0.0), 0.25));
  }
  const auto middle = sigmas_px.begin() + static_cast<std::ptrdiff_t>(sigmas_px.size() / 2);
  std::ranges::nth_element(sigmas_px, middle);
  return *middle;
}

}  // namespace

BenchScene::BenchScene(const test::SplatSceneShape& shape) {
  test::SplatScene scene = test::splat_scene(shape);
  cloud = std::move(scene.cloud);
  view = *splat::View::from(scene.camera, {});
  measure();
}

BenchScene::BenchScene(gaussian::GaussianCloud given, const geometry::CameraModel& camera)
    : cloud(std::move(given)), view(*splat::View::from(camera, {})) {
  measure();
}

void BenchScene::measure() {
  const auto count = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
  colour.resize(3 * count);
  depth_sum_m.resize(count);
  alpha.resize(count);
  const splat::RenderOptions options;
  const auto projected = *splat::project(core::Backend::kCpu, splat::spans_of(cloud), view, options);
  const auto tiles = splat::make_tile_lists(projected.splats, view.width_px, view.height_px);
  visible = projected.splats.size();
  tile_pairs = tiles.entries.size();
  for (const splat::TileEntry& entry : tiles.entries)
    evaluations += splat::kBlockPixels * std::popcount(entry.reached);
  median_sigma_px = median_sigma(projected.splats, options.low_pass_px2);
  (void)splat::render(core::Backend::kCpu, splat::spans_of(cloud), view, {}, {colour, depth_sum_m, alpha});
}

}  // namespace edgesplat::bench
