// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace edgesplat {

/// The clock of a device: ns since whatever its epoch is. A SensorTime is comparable only with others of the
/// same device; ClockMap converts it to HostTime.
struct SensorClock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<SensorClock, duration>;
  static constexpr bool is_steady = false;
};
/// The clock of the computer that runs the program (steady), or the virtual clock of a replay.
struct HostClock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<HostClock, duration>;
  static constexpr bool is_steady = true;
};

using SensorTime = SensorClock::time_point;  ///< SensorTime - HostTime does not compile
using HostTime = HostClock::time_point;
using std::chrono::nanoseconds;

constexpr std::int64_t to_ns(SensorTime t) {
  return t.time_since_epoch().count();
}
constexpr std::int64_t to_ns(HostTime t) {
  return t.time_since_epoch().count();
}
constexpr SensorTime sensor_time_from_ns(std::int64_t ns) {
  return SensorTime(nanoseconds(ns));
}
constexpr HostTime host_time_from_ns(std::int64_t ns) {
  return HostTime(nanoseconds(ns));
}

/// A duration in seconds for arithmetic with rates; stamps stay integers (a double loses ns after 104 days).
constexpr double to_seconds(nanoseconds d) {
  return std::chrono::duration<double>(d).count();
}
constexpr nanoseconds from_seconds(double seconds) {
  return nanoseconds(static_cast<std::int64_t>(seconds * 1e9 + (seconds < 0 ? -0.5 : 0.5)));
}

}  // namespace edgesplat
