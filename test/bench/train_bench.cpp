// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/optimiser.hpp"
#include "kernels/splat/render.hpp"
#include "kernels/train/ssim.hpp"
#include "test/support/random_cloud.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

namespace edgesplat::mapping {
namespace {

/// state.range(0) Gaussians of SH degree state.range(2), all in view, 1.5 to 6 px wide (one sigma) in a
/// picture of 1280/n x 1024/n, n = state.range(1): some 400 pixels in the box of each. The picture to reach
/// is that of another such cloud.
struct Scene {
  explicit Scene(const benchmark::State& state)
      : width_px(static_cast<int>(1280 / state.range(1))),
        height_px(static_cast<int>(1024 / state.range(1))) {
    const geometry::CameraModel model{geometry::CameraKind::kPinhole,
                                      width_px,
                                      height_px,
                                      0.8 * width_px,
                                      0.8 * width_px,
                                      0.5 * width_px,
                                      0.5 * height_px,
                                      {}};
    view = *splat::View::from(model, {});
    test::Random random(1);
    cloud = random_cloud(random, state);
    const auto pixels = static_cast<std::size_t>(width_px * height_px);
    colour.resize(3 * pixels);
    depth_m.resize(pixels);
    std::vector<float> alpha(pixels);
    const auto other = random_cloud(random, state);
    const auto stats =
        splat::render(core::Backend::kCpu, splat::spans_of(other), view, {}, {colour, depth_m, alpha});
    tile_pairs = stats->tile_pairs;
  }
  [[nodiscard]] gaussian::GaussianCloud random_cloud(test::Random& random,
                                                     const benchmark::State& state) const {
    test::CloudShape shape;
    shape.count = static_cast<std::size_t>(state.range(0));
    shape.sh_degree = static_cast<int>(state.range(2));
    auto made = test::random_cloud(random, shape);
    for (std::size_t i = 0; i < made.size(); ++i) {
      float* mean_m = &made.means_m[3 * i];
      mean_m[0] = (static_cast<float>(random.uniform(0.0, width_px)) - view.cx_px) / view.fx_px * mean_m[2];
      mean_m[1] = (static_cast<float>(random.uniform(0.0, height_px)) - view.cy_px) / view.fy_px * mean_m[2];
      for (std::size_t k = 0; k < 3; ++k) {
        const double sigma_px = std::exp(random.uniform(std::log(1.5), std::log(6.0)));
        made.log_scales[3 * i + k] = std::log(static_cast<float>(sigma_px) * mean_m[2] / view.fx_px);
      }
    }
    return made;
  }
  int width_px, height_px;
  splat::View view;
  gaussian::GaussianCloud cloud;
  std::vector<float> colour, depth_m;
  std::size_t tile_pairs = 0;
};

double milliseconds(std::chrono::nanoseconds time) {
  return static_cast<double>(time.count()) * 1e-6;
}

/// One whole iteration: forward, L1 + SSIM + depth, backward, Adam.
void step_cpu(benchmark::State& state) {
  const Scene scene(state);
  const SteadyClock clock;
  OptimiserOptions options;
  options.sh_degree = static_cast<int>(state.range(2));
  auto optimiser = Optimiser::create(options, clock);
  if (!optimiser || !optimiser->add_rows(scene.cloud)) return;
  StepTimes sum;
  std::size_t visible = 0;
  for (auto _ : state) {
    const auto report = optimiser->step({scene.view, scene.colour, scene.depth_m, {}, {}});
    sum.forward += report->times.forward;
    sum.loss += report->times.loss;
    sum.backward += report->times.backward;
    sum.update += report->times.update;
    visible = report->visible;
  }
  const auto steps = static_cast<double>(state.iterations());
  state.counters["forward_ms"] = milliseconds(sum.forward) / steps;
  state.counters["loss_ms"] = milliseconds(sum.loss) / steps;
  state.counters["backward_ms"] = milliseconds(sum.backward) / steps;
  state.counters["update_ms"] = milliseconds(sum.update) / steps;
  state.counters["visible"] = static_cast<double>(visible);
  state.counters["tile_pairs"] = static_cast<double>(scene.tile_pairs);
}

void ssim_backward_cpu(benchmark::State& state) {
  const Scene scene(state);
  std::vector<float> by_drawn(scene.colour.size());
  const std::vector<float> drawn(scene.colour.size(), 0.5F);
  const train::ColourPair pair{scene.width_px, scene.height_px, drawn, scene.colour, {}};
  for (auto _ : state) benchmark::DoNotOptimize(train::ssim_backward(pair, 1.0F, by_drawn));
  state.SetItemsProcessed(state.iterations() * scene.width_px * scene.height_px);
}

BENCHMARK(step_cpu)
    ->Args({10000, 4, 0})
    ->Args({50000, 2, 0})
    ->Args({200000, 1, 0})
    ->Args({200000, 1, 3})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(ssim_backward_cpu)
    ->Args({10, 1, 0})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace edgesplat::mapping
