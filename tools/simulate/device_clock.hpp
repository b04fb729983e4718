// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "common/time/time.hpp"
#include "tools/simulate/noise.hpp"

#include <cstdint>

namespace edgesplat::simulate {

/// True time 0 of every simulation, in ns of Unix time: a robot with PTP has such stamps.
inline constexpr std::int64_t kEpoch_ns = 1'700'000'000'000'000'000;

enum class ClockMode : std::uint8_t {
  kFree,  ///< counts since the device was switched on, at its own crystal's rate
  kPtp,   ///< disciplined to the host's clock, up to the servo's noise
};

struct DeviceClockConfig {
  ClockMode mode = ClockMode::kPtp;
  double max_drift_ppm = 50.0;   ///< free: the crystal's error is drawn from +- this
  double jitter_sigma_s = 1e-6;  ///< free: of each stamp
  double servo_sigma_s = 3e-6;   ///< ptp: slow wander of the servo
  double servo_step_s = 1.0;     ///< ptp: how often the servo corrects
};

/// The clock inside one simulated device: what it writes on a measurement taken at a true time. A pure
/// function of (seed, device, true time). Immutable, thread-safe.
class DeviceClock {
 public:
  DeviceClock(const DeviceClockConfig& config, NoisePurpose device, std::uint64_t seed);

  /// `true_time` is host time, see kEpoch_ns.
  [[nodiscard]] SensorTime stamp(HostTime true_time) const;
  [[nodiscard]] sensor::StampSource source() const;
  /// The crystal's error; 0 in ptp mode.
  [[nodiscard]] double drift_ppm() const { return drift_ppm_; }

 private:
  [[nodiscard]] double servo_error_ns(std::int64_t step) const;
  DeviceClockConfig config_;
  NoisePurpose device_;
  std::uint64_t seed_;
  double drift_ppm_ = 0.0;
  std::int64_t switched_on_ns_ = 0;  ///< free: true time at which the device's counter was 0
};

/// When datagrams reach the host: true time of sending + latency + an exponential tail; one stream never
/// overtakes itself. Single-owner.
class ArrivalModel {
 public:
  ArrivalModel(double latency_s, double mean_jitter_s, std::uint64_t seed, std::uint64_t stream)
      : latency_s_(latency_s), mean_jitter_s_(mean_jitter_s), noise_(seed, NoisePurpose::kArrival, stream) {}
  HostTime arrival(HostTime sent);

 private:
  double latency_s_;
  double mean_jitter_s_;
  NoiseStream noise_;
  HostTime latest_{};
};

}  // namespace edgesplat::simulate
