// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/pacer.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace edgesplat::virtual_device {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kLate_ns = 5'000'000;
constexpr std::int64_t kStopCheck_ns = 200'000'000;  // a long gap in the recording must not delay Ctrl-C

std::int64_t steady_now_ns() {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<std::int64_t>(t.tv_sec) * kSecond_ns + t.tv_nsec;
}

void sleep_until(std::int64_t deadline_ns) {
  const timespec t{static_cast<time_t>(deadline_ns / kSecond_ns),
                   static_cast<long>(deadline_ns % kSecond_ns)};
  (void)::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr);
}

}  // namespace

bool Pacer::wait_for(HostTime recorded, const std::stop_token& stop) {
  std::int64_t now_ns = steady_now_ns();
  if (!started_) {
    started_ = true;
    first_recorded_ = recorded;
    start_ns_ = now_ns;
  }
  const double after_ns = static_cast<double>((recorded - first_recorded_).count()) / speed_;
  const std::int64_t deadline_ns = start_ns_ + std::llround(after_ns);
  const std::int64_t late_ns = now_ns - deadline_ns;
  if (late_ns > kLate_ns) ++late_;
  most_late_ = std::max(most_late_, nanoseconds(late_ns));
  while (now_ns < deadline_ns) {
    if (stop.stop_requested()) return false;
    sleep_until(std::min(deadline_ns, now_ns + kStopCheck_ns));
    now_ns = steady_now_ns();
  }
  return !stop.stop_requested();
}

}  // namespace edgesplat::virtual_device
