// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/optimiser.hpp"
#include "kernels/train/ssim.hpp"
#include "test/bench/bench_counters.hpp"
#include "test/bench/bench_scene.hpp"

#include <benchmark/benchmark.h>

#include <utility>
#include <vector>

namespace edgesplat::bench {
namespace {

test::SplatSceneShape shape_of(const benchmark::State& state) {
  return {static_cast<std::size_t>(state.range(0)), static_cast<int>(1280 / state.range(1)),
          static_cast<int>(1024 / state.range(1)), static_cast<int>(state.range(2))};
}

double milliseconds(std::chrono::nanoseconds time) {
  return static_cast<double>(time.count()) * 1e-6;
}

/// What a picture should look like, without the Gaussians that made it: memory is measured as well.
struct Target {
  explicit Target(const test::SplatSceneShape& shape) {
    BenchScene scene(shape);
    colour = std::move(scene.colour);
    depth_sum_m = std::move(scene.depth_sum_m);
  }
  std::vector<float> colour, depth_sum_m;
};

/// One whole iteration: forward, L1 + SSIM + depth, backward, Adam. The picture to reach is that of another
/// such scene.
void step_cpu(benchmark::State& state) {
  auto shape = shape_of(state);
  const BenchScene scene(shape);
  shape.seed = 2;
  const Target target(shape);
  const SteadyClock clock;
  mapping::OptimiserOptions options;
  options.sh_degree = shape.sh_degree;
  auto optimiser = mapping::Optimiser::create(options, clock);
  if (!optimiser || !optimiser->add_rows(scene.cloud)) return state.SkipWithError("the scene does not fit");
  // The first step takes the memory from the system: of a thousand steps it is one, of a second's ten.
  const mapping::TrainingView view{scene.view, target.colour, target.depth_sum_m, {}, {}};
  if (!optimiser->step(view)) return state.SkipWithError("the step fails");
  mapping::StepTimes sum;
  std::size_t moved = 0;
  for (auto _ : state) {
    const auto report = optimiser->step(view);
    sum.forward += report->times.forward;
    sum.loss += report->times.loss;
    sum.backward += report->times.backward;
    sum.update += report->times.update;
    moved = report->visible;
  }
  const auto steps = static_cast<double>(state.iterations());
  state.counters["forward_ms"] = milliseconds(sum.forward) / steps;
  state.counters["loss_ms"] = milliseconds(sum.loss) / steps;
  state.counters["backward_ms"] = milliseconds(sum.backward) / steps;
  state.counters["update_ms"] = milliseconds(sum.update) / steps;
  state.counters["moved"] = static_cast<double>(moved);
  set_counters(state, scene);
}

void colour_loss_cpu(benchmark::State& state) {
  const BenchScene scene(shape_of(state));
  std::vector<float> by_drawn(scene.colour.size());
  const std::vector<float> drawn(scene.colour.size(), 0.5F);
  const train::ColourPair pair{scene.view.width_px, scene.view.height_px, drawn, scene.colour, {}};
  for (auto _ : state) benchmark::DoNotOptimize(train::ssim_l1_backward(pair, -0.2F, 0.8F, by_drawn).ssim);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scene.pixels()));
}

BENCHMARK(step_cpu)
    ->ArgNames({"gaussians", "shrink", "sh"})
    ->Args({10000, 4, 3})
    ->Args({50000, 2, 3})
    ->Args({200000, 1, 3})
    ->Args({200000, 1, 0})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(colour_loss_cpu)
    ->ArgNames({"gaussians", "shrink", "sh"})
    ->Args({10, 1, 0})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace edgesplat::bench
