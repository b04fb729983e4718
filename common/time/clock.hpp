// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <atomic>

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

}  // namespace edgesplat
