// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/clock.hpp"

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <thread>

namespace edgesplat::desk {

/// Processor time of this process over the cores: what a clock would show if the process had all of them to
/// itself and kept them busy; over one core, what it spent in all its threads. For figures on a machine that
/// others use too. Thread-safe.
class ProcessorClock final : public Clock {
 public:
  explicit ProcessorClock(unsigned cores = std::thread::hardware_concurrency())
      : cores_(std::max(1U, cores)) {}

  [[nodiscard]] HostTime now() const override {
    timespec time{};
    (void)::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    const std::int64_t spent_ns = std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
    return host_time_from_ns(spent_ns / std::int64_t{cores_});
  }

 private:
  unsigned cores_;
};

}  // namespace edgesplat::desk
