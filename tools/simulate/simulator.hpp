// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "tools/simulate/simulate_options.hpp"

#include <cstdint>
#include <functional>
#include <stop_token>

namespace edgesplat::simulate {

struct SimulateReport {
  std::uint64_t point_packets = 0;
  std::uint64_t imu_packets = 0;
  std::uint64_t frames = 0;
  std::uint64_t bytes = 0;  ///< of the recording
  double driven_m = 0.0;    ///< along the true path
  bool stopped = false;     ///< ended early by request; the recording is whole up to there
};

/// Called after every 0.1 s of simulated time.
using SimulateProgress = std::function<void(double simulated_s)>;

/// Drives the robot through the world and writes what its sensors measured as a recording, with the truth.
/// The same options give the same bytes. Uses all cores. Errors: kInvalidConfig, kIo.
[[nodiscard]] Result<SimulateReport> simulate(const SimulateOptions& options,
                                              const SimulateProgress& progress, const std::stop_token& stop);

}  // namespace edgesplat::simulate
