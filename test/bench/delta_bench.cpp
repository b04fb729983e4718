// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/delta_codec.hpp"
#include "common/map/map_state.hpp"
#include "server/stream/delta_stream.hpp"
#include "test/support/map_samples.hpp"
#include "test/support/random_cloud.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace edgesplat::stream {
namespace {

constexpr std::size_t kPlenty_bytes = std::size_t{1} << 30U;

/// Gaussians as LiDAR leaves them: on walls 0.1 m apart, flat, opacity 0.9, colours that vary slowly.
gaussian::GaussianCloud wall(std::size_t count) {
  test::Random random(1);
  auto cloud = test::random_gaussians(count, 1);
  for (std::size_t row = 0; row < count; ++row) {
    const std::size_t column = row / 64;
    const double along_m = 0.1 * static_cast<double>(column);
    cloud.means_m[3 * row] = static_cast<float>(along_m + random.uniform(-0.03, 0.03));
    cloud.means_m[3 * row + 1] = static_cast<float>(random.uniform(-0.02, 0.02));
    cloud.means_m[3 * row + 2] = static_cast<float>(0.05 * static_cast<double>(row % 64));
    for (std::size_t k = 0; k < 3; ++k) {
      cloud.log_scales[3 * row + k] = static_cast<float>((k == 2 ? -4.6 : -3.0) + random.uniform(-0.2, 0.2));
      cloud.sh[3 * row + k] =
          static_cast<float>(std::sin(along_m + static_cast<double>(k)) + random.uniform(-0.1, 0.1));
      cloud.quats_xyzw[4 * row + k] = static_cast<float>(random.uniform(-0.05, 0.05));
    }
    cloud.quats_xyzw[4 * row + 3] = 1.0F;
    cloud.opacity_logits[row] = 2.2F;
  }
  return cloud;
}

/// A few steps of an optimiser: all parameters move a little.
void optimise(gaussian::GaussianCloud& cloud, test::Random& random) {
  const auto nudge = [&](std::vector<float>& values, double by) {
    for (float& v : values) v += static_cast<float>(random.normal() * by);
  };
  nudge(cloud.means_m, 0.002);
  nudge(cloud.log_scales, 0.04);
  nudge(cloud.quats_xyzw, 0.01);
  nudge(cloud.opacity_logits, 0.15);
  nudge(cloud.sh, 0.05);
}

std::vector<std::uint32_t> all_rows(const gaussian::GaussianCloud& cloud) {
  std::vector<std::uint32_t> rows(cloud.size());
  std::iota(rows.begin(), rows.end(), 0U);
  return rows;
}

void add(benchmark::State& state) {
  const auto cloud = wall(static_cast<std::size_t>(state.range(0)));
  const auto rows = all_rows(cloud);
  double bytes_each = 0.0;
  for (auto _ : state) {
    DeltaStream stream({});
    benchmark::DoNotOptimize(stream.publish(cloud, rows, {}, kPlenty_bytes));
    bytes_each = static_cast<double>(stream.counters().add_bytes) / static_cast<double>(rows.size());
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
  state.counters["bytes_each"] = bytes_each;
}

/// Publishes an optimised map again and again, each time within `budget_bytes`.
void publish_changes(benchmark::State& state, std::size_t budget_bytes) {
  auto cloud = wall(static_cast<std::size_t>(state.range(0)));
  const auto rows = all_rows(cloud);
  DeltaStream stream({});
  (void)stream.publish(cloud, rows, {}, kPlenty_bytes);
  test::Random random(2);
  for (auto _ : state) {
    state.PauseTiming();
    optimise(cloud, random);
    state.ResumeTiming();
    benchmark::DoNotOptimize(stream.publish(cloud, rows, {}, budget_bytes));
  }
  const auto counters = stream.counters();
  state.SetItemsProcessed(static_cast<std::int64_t>(counters.updated));
  state.counters["bytes_each"] =
      static_cast<double>(counters.update_bytes) / static_cast<double>(counters.updated);
}

void update(benchmark::State& state) {
  publish_changes(state, kPlenty_bytes);
}

void update_within_budget(benchmark::State& state) {
  publish_changes(state, 30000);
}

void apply(benchmark::State& state) {
  auto cloud = wall(static_cast<std::size_t>(state.range(0)));
  const auto rows = all_rows(cloud);
  DeltaStream stream({});
  const auto added = stream.publish(cloud, rows, {}, kPlenty_bytes);
  test::Random random(2);
  optimise(cloud, random);
  const auto updated = stream.publish(cloud, rows, {}, kPlenty_bytes);
  for (auto _ : state) {
    map::MapState robot;
    for (const auto* deltas : {&added, &updated}) {
      for (const auto& delta : *deltas) (void)robot.apply(*map::decode_delta(delta));
    }
    benchmark::DoNotOptimize(robot.hash());
  }
  state.SetItemsProcessed(state.iterations() * 2 * state.range(0));
}

void dequantise(benchmark::State& state) {
  const auto rows = test::quantised(wall(static_cast<std::size_t>(state.range(0))));
  for (auto _ : state) benchmark::DoNotOptimize(map::dequantise(rows));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

BENCHMARK(add)->Arg(1000)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(update)->Arg(1000)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(update_within_budget)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(apply)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(dequantise)->Arg(100000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace edgesplat::stream
