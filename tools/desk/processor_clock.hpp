// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/clock.hpp"

#include <algorithm>
#include <ctime>
#include <thread>

namespace edgesplat::desk {

/// Processor time of this process over the machine's cores: what a clock would show if the process had all of
/// them to itself and kept them busy. For figures on a machine that others use too. Thread-safe.
class ProcessorClock final : public Clock {
 public:
  [[nodiscard]] HostTime now() const override {
    timespec time{};
    (void)::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    const std::int64_t spent_ns = std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
    return host_time_from_ns(spent_ns / std::max<std::int64_t>(1, std::thread::hardware_concurrency()));
  }
};

}  // namespace edgesplat::desk
