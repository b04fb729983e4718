// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/device_clock.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::simulate {

DeviceClock::DeviceClock(const DeviceClockConfig& config, NoisePurpose device, std::uint64_t seed)
    : config_(config), device_(device), seed_(seed) {
  if (config_.mode == ClockMode::kPtp) return;
  NoiseStream noise(seed_, device_, ~0ULL);
  drift_ppm_ = config_.max_drift_ppm * (2.0 * noise.uniform() - 1.0);
  switched_on_ns_ = kEpoch_ns - to_ns(host_time_from_ns(0) + from_seconds(5.0 + 100.0 * noise.uniform()));
}

double DeviceClock::servo_error_ns(std::int64_t step) const {
  return config_.servo_sigma_s * 1e9 *
         NoiseStream(seed_, device_, static_cast<std::uint64_t>(step)).gaussian();
}

SensorTime DeviceClock::stamp(HostTime true_time) const {
  const std::int64_t true_ns = to_ns(true_time);
  if (config_.mode == ClockMode::kFree) {
    const auto running_ns = static_cast<double>(true_ns - switched_on_ns_);
    const double jitter_ns = config_.jitter_sigma_s * 1e9 *
                             NoiseStream(seed_, device_, static_cast<std::uint64_t>(true_ns)).gaussian();
    const auto error_ns = static_cast<std::int64_t>(std::llround(1e-6 * drift_ppm_ * running_ns + jitter_ns));
    return sensor_time_from_ns(true_ns - switched_on_ns_ + error_ns);
  }
  const double position = to_seconds(nanoseconds(true_ns - kEpoch_ns)) / config_.servo_step_s;
  const double step = std::floor(position);
  const double t = position - step;
  const auto first = static_cast<std::int64_t>(step);
  const double error_ns = (1.0 - t) * servo_error_ns(first) + t * servo_error_ns(first + 1);
  return sensor_time_from_ns(true_ns + std::llround(error_ns));
}

sensor::StampSource DeviceClock::source() const {
  return config_.mode == ClockMode::kPtp ? sensor::StampSource::kPtp : sensor::StampSource::kFreeRunning;
}

HostTime ArrivalModel::arrival(HostTime sent) {
  const HostTime time = sent + from_seconds(latency_s_ + mean_jitter_s_ * noise_.exponential());
  latest_ = std::max(latest_, time);
  return latest_;
}

}  // namespace edgesplat::simulate
