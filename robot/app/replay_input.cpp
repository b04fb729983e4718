// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/replay_input.hpp"

#include "common/thread/pause.hpp"

#include <utility>

namespace edgesplat::app {

bool ReplayInput::wait_until_due(HostTime arrival, HostTime started, std::stop_token& stop) const {
  const nanoseconds recorded = arrival - source_.begin();
  const HostTime due = started + from_seconds(to_seconds(recorded) / speed_);
  const nanoseconds wait = due - clock_.now();
  if (wait <= nanoseconds(0)) return !stop.stop_requested();
  thread::pause(stop, wait);
  return !stop.stop_requested();
}

Status ReplayInput::run(const Sink& sink, std::stop_token stop) {
  const HostTime started = clock_.now();
  while (!stop.stop_requested()) {
    EDGESPLAT_TRY(std::optional<sensor::Measurement> measurement, source_.next());
    if (!measurement) break;
    const HostTime arrival = arrival_of(*measurement);
    const double played_s = to_seconds(arrival - source_.begin());
    if (limit_s_ > 0 && played_s > limit_s_) break;
    if (speed_ > 0 && !wait_until_due(arrival, started, stop)) break;
    played_s_.store(played_s, std::memory_order_relaxed);
    sink(std::move(*measurement));
  }
  return {};
}

}  // namespace edgesplat::app
