// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/render.hpp"
#include "test/support/random_cloud.hpp"

#include <benchmark/benchmark.h>

#include <vector>

namespace edgesplat::splat {
namespace {

/// A room-sized cloud of small Gaussians, all in view: state.range(0) of them, picture 1280/n x 1024/n with n
/// = state.range(1).
struct Scene {
  explicit Scene(const benchmark::State& state)
      : width_px(static_cast<int>(1280 / state.range(1))),
        height_px(static_cast<int>(1024 / state.range(1))) {
    test::Random random(1);
    test::CloudShape shape;
    shape.count = static_cast<std::size_t>(state.range(0));
    shape.scale_min_m = 0.01;
    shape.scale_max_m = 0.05;
    cloud = test::random_cloud(random, shape);
    const geometry::CameraModel model{geometry::CameraKind::kPinhole,
                                      width_px,
                                      height_px,
                                      0.8 * width_px,
                                      0.8 * width_px,
                                      0.5 * width_px,
                                      0.5 * height_px,
                                      {}};
    view = *View::from(model, {});
  }
  int width_px, height_px;
  gaussian::GaussianCloud cloud;
  View view;
};

void project_cpu(benchmark::State& state) {
  const Scene scene(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(project(core::Backend::kCpu, spans_of(scene.cloud), scene.view, {}));
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void tiles_cpu(benchmark::State& state) {
  const Scene scene(state);
  const auto projected = project(core::Backend::kCpu, spans_of(scene.cloud), scene.view, {});
  for (auto _ : state)
    benchmark::DoNotOptimize(make_tile_lists(projected->splats, scene.width_px, scene.height_px));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void render_cpu(benchmark::State& state) {
  const Scene scene(state);
  const auto pixels = static_cast<std::size_t>(scene.width_px * scene.height_px);
  std::vector<float> colour(3 * pixels), depth(pixels), alpha(pixels);
  RenderStats stats;
  for (auto _ : state) {
    stats = *render(core::Backend::kCpu, spans_of(scene.cloud), scene.view, {}, {colour, depth, alpha});
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
  state.counters["visible"] = static_cast<double>(stats.visible);
  state.counters["tile_pairs"] = static_cast<double>(stats.tile_pairs);
}

BENCHMARK(project_cpu)->Args({200000, 4})->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(tiles_cpu)->Args({200000, 4})->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(render_cpu)
    ->Args({10000, 4})
    ->Args({200000, 4})
    ->Args({200000, 2})
    ->Args({200000, 1})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace edgesplat::splat
