// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// How time and memory grow with Gaussians and pixels; `tools/bench --scale` runs each in a process of its
// own.
#include "kernels/mapping/optimiser.hpp"
#include "test/bench/bench_counters.hpp"
#include "test/bench/bench_scene.hpp"

#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

namespace edgesplat::bench {
namespace {

/// Arguments: Gaussians, width, height.
test::SplatSceneShape shape_of(const benchmark::State& state, int sh_degree) {
  return {static_cast<std::size_t>(state.range(0)), static_cast<int>(state.range(1)),
          static_cast<int>(state.range(2)), sh_degree};
}

void scale_forward(benchmark::State& state) {
  BenchScene scene(shape_of(state, 0));
  splat::RenderScratch scratch;
  const auto draw = [&] {
    benchmark::DoNotOptimize(splat::render_cpu(splat::spans_of(scene.cloud), scene.view, {},
                                               {scene.colour, scene.depth_sum_m, scene.alpha}, scratch));
  };
  draw();  // the first one pays for the memory
  for (auto _ : state) draw();
  set_counters(state, scene);
}

void scale_step(benchmark::State& state) {
  const BenchScene scene(shape_of(state, 3));
  const SteadyClock clock;
  mapping::OptimiserOptions options;
  options.sh_degree = 3;
  options.max_gaussians = scene.cloud.size();
  auto optimiser = mapping::Optimiser::create(options, clock);
  if (!optimiser || !optimiser->add_rows(scene.cloud)) return state.SkipWithError("the scene does not fit");
  const std::vector<float> grey(scene.colour.size(), 0.5F);
  const auto step = [&] {
    benchmark::DoNotOptimize(optimiser->step({scene.view, grey, scene.depth_sum_m, {}, {}}));
  };
  for (int i = 0; i < 3; ++i) step();  // the first ones pay for the memory
  for (auto _ : state) step();
  set_counters(state, scene);
}

void all_sizes(benchmark::internal::Benchmark* benchmark) {
  constexpr std::int64_t kCounts[] = {10'000, 30'000, 100'000, 300'000, 1'000'000, 3'000'000};
  constexpr std::int64_t kSizes[][2] = {{320, 256}, {640, 512}, {1280, 1024}, {1920, 1080}};
  for (const std::int64_t count : kCounts) {
    for (const auto& size : kSizes) benchmark->Args({count, size[0], size[1]});
  }
}

BENCHMARK(scale_forward)
    ->Apply(all_sizes)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(scale_step)
    ->Apply(all_sizes)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace edgesplat::bench
