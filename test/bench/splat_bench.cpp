// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/gaussian_file.hpp"
#include "kernels/splat/tile_lists.hpp"
#include "test/bench/bench_counters.hpp"
#include "test/bench/bench_scene.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace edgesplat::bench {
namespace {

/// Arguments of a benchmark: Gaussians, 1280/n x 1024/n, SH degree, one in so many in view.
test::SplatSceneShape shape_of(const benchmark::State& state) {
  return {static_cast<std::size_t>(state.range(0)), static_cast<int>(1280 / state.range(1)),
          static_cast<int>(1024 / state.range(1)), static_cast<int>(state.range(2)),
          static_cast<int>(state.range(3))};
}

void draw(benchmark::State& state, BenchScene& scene) {
  splat::RenderScratch scratch;
  for (auto _ : state) {
    benchmark::DoNotOptimize(splat::render_cpu(splat::spans_of(scene.cloud), scene.view, {},
                                               {scene.colour, scene.depth_sum_m, scene.alpha}, scratch));
  }
  set_counters(state, scene);
}

void forward_cpu(benchmark::State& state) {
  BenchScene scene(shape_of(state));
  draw(state, scene);
}

void project_cpu(benchmark::State& state) {
  const BenchScene scene(shape_of(state));
  splat::RenderScratch scratch;
  for (auto _ : state) {
    benchmark::DoNotOptimize(splat::project(core::Backend::kCpu, splat::spans_of(scene.cloud), scene.view, {},
                                            scratch.project, scratch.projected));
  }
  set_counters(state, scene);
}

void tiles_cpu(benchmark::State& state) {
  const BenchScene scene(shape_of(state));
  const auto projected = splat::project(core::Backend::kCpu, splat::spans_of(scene.cloud), scene.view, {});
  splat::RenderScratch scratch;
  for (auto _ : state) {
    splat::make_tile_lists(projected->splats, scene.view.width_px, scene.view.height_px,
                           scratch.tiles_scratch, scratch.tiles);
  }
  set_counters(state, scene);
}

/// The trained scene of ../shared as a visitor sees it first: from in front of it, all of it in the picture.
std::unique_ptr<BenchScene> biker_scene() {
  auto cloud = io::read_gaussians(EDGESPLAT_SOURCE_DIR "/../shared/data/splats/biker.spz");
  if (!cloud) return nullptr;
  geometry::CameraModel camera{geometry::CameraKind::kPinhole, 1280, 720, 1000.0, 1000.0, 640.0, 360.0, {}};
  // The middle of the scene, without the stray ones.
  double middle_m[3], extent_m = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<float> axis;
    for (std::size_t i = 0; i < cloud->size(); ++i) axis.push_back(cloud->means_m[3 * i + k]);
    std::ranges::sort(axis);
    middle_m[k] = static_cast<double>(axis[axis.size() / 2]);
    extent_m = std::max(extent_m, static_cast<double>(axis[axis.size() * 19 / 20] - axis[axis.size() / 20]));
  }
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) cloud->means_m[3 * i + k] -= static_cast<float>(middle_m[k]);
    cloud->means_m[3 * i + 2] += static_cast<float>(1.6 * extent_m);
  }
  return std::make_unique<BenchScene>(std::move(*cloud), camera);
}

void forward_cpu_biker(benchmark::State& state) {
  const auto scene = biker_scene();
  if (!scene) return state.SkipWithError("no ../shared/data/splats/biker.spz");
  draw(state, *scene);
}

BENCHMARK(forward_cpu)
    ->ArgNames({"gaussians", "shrink", "sh", "share"})
    ->Args({10000, 4, 0, 1})
    ->Args({50000, 2, 0, 1})
    ->Args({200000, 1, 0, 1})
    ->Args({1500000, 1, 0, 3})
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(forward_cpu_biker)->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(project_cpu)
    ->ArgNames({"gaussians", "shrink", "sh", "share"})
    ->Args({200000, 1, 3, 1})
    ->Args({1500000, 1, 0, 3})
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(tiles_cpu)
    ->ArgNames({"gaussians", "shrink", "sh", "share"})
    ->Args({200000, 1, 0, 1})
    ->Args({1500000, 1, 0, 3})
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace edgesplat::bench
