// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "test/bench/bench_scene.hpp"
#include "test/bench/calibration.hpp"

#include <benchmark/benchmark.h>

namespace edgesplat::bench {

/// After the loop: what there was to do, and how long the machine takes for a fixed piece of work just now.
inline void set_counters(benchmark::State& state, const BenchScene& scene) {
  state.counters["visible"] = static_cast<double>(scene.visible);
  state.counters["tile_pairs"] = static_cast<double>(scene.tile_pairs);
  state.counters["evaluations"] = scene.evaluations;
  state.counters["sigma_px"] = scene.median_sigma_px;
  state.counters["calibration_ms"] = calibration_ms();
}

}  // namespace edgesplat::bench
