// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <atomic>
#include <cstdint>
#include <functional>

namespace edgesplat {

/// CLOCK_REALTIME, ns: for what the system or a device stamps by it. It jumps; nothing is timed by it.
[[nodiscard]] std::int64_t wall_clock_ns();

/// Where a program gets its time from. Injected everywhere; nothing calls a system clock by itself.
/// Thread-safe.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual HostTime now() const = 0;
};

/// CLOCK_MONOTONIC: wall-clock jumps change nothing.
class SteadyClock final : public Clock {
 public:
  [[nodiscard]] HostTime now() const override;
};

/// Virtual time for --lockstep and tests: stands still until somebody advances it, never goes back.
class VirtualClock final : public Clock {
 public:
  explicit VirtualClock(HostTime start = HostTime{}) : now_ns_(to_ns(start)) {}
  [[nodiscard]] HostTime now() const override { return host_time_from_ns(now_ns_.load()); }
  /// Moves time to `t`; an earlier time than now() is ignored.
  void advance_to(HostTime t);

 private:
  std::atomic<std::int64_t> now_ns_;
};

/// The wall clock and the program's at one moment.
struct ClockPair {
  std::int64_t wall_ns = 0;
  HostTime host{};
  nanoseconds spread{};  ///< the two were read at most half of this apart

  /// What the wall clock showed `wall` at, as long as it was not set meanwhile.
  [[nodiscard]] HostTime host_at(std::int64_t wall) const { return host - nanoseconds(wall_ns - wall); }
};

/// Reads both, between two readings of the program's clock; again, a few times, where the thread was held up
/// in between. `wall_ns`: what stamps are made with.
[[nodiscard]] ClockPair read_clocks(const Clock& clock,
                                    const std::function<std::int64_t()>& wall_ns = wall_clock_ns);

}  // namespace edgesplat
