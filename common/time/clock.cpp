// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/time/clock.hpp"

#include <ctime>

namespace edgesplat {

std::int64_t wall_clock_ns() {
  timespec now{};
  (void)::clock_gettime(CLOCK_REALTIME, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

HostTime SteadyClock::now() const {
  return HostTime(
      std::chrono::duration_cast<nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()));
}

void VirtualClock::advance_to(HostTime t) {
  std::int64_t seen = now_ns_.load();
  while (seen < to_ns(t) && !now_ns_.compare_exchange_weak(seen, to_ns(t))) {
  }
}

ClockPair read_clocks(const Clock& clock, const std::function<std::int64_t()>& wall_ns) {
  constexpr int kTries = 5;
  constexpr nanoseconds kNarrow = std::chrono::microseconds(20);
  ClockPair best;
  for (int i = 0; i < kTries; ++i) {
    const HostTime before = clock.now();
    const std::int64_t wall = wall_ns();
    const nanoseconds spread = clock.now() - before;
    if (i == 0 || spread < best.spread) best = {wall, before + spread / 2, spread};
    if (best.spread <= kNarrow) break;
  }
  return best;
}

}  // namespace edgesplat
