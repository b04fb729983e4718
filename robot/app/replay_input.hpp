// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/time/clock.hpp"
#include "robot/drivers/replay/replay_source.hpp"

#include <atomic>
#include <functional>
#include <stop_token>

namespace edgesplat::app {

/// Plays a recording into a sink at a pace. Single-owner; run() belongs to one thread, played_s() to any.
class ReplayInput {
 public:
  using Sink = std::function<void(sensor::Measurement)>;

  /// `speed` 1 is real time, 0 as fast as the sink takes them; `limit_s` > 0 ends after that much recorded
  /// time.
  ReplayInput(replay::ReplaySource& source, double speed, double limit_s, const Clock& clock)
      : source_(source), speed_(speed), limit_s_(limit_s), clock_(clock) {}

  /// Until the recording ends, the limit is reached or `stop` is requested. Errors: those of
  /// ReplaySource::next.
  [[nodiscard]] Status run(const Sink& sink, std::stop_token stop);
  /// Recorded time played so far.
  [[nodiscard]] double played_s() const { return played_s_.load(std::memory_order_relaxed); }

 private:
  /// False when `stop` came first.
  bool wait_until_due(HostTime arrival, HostTime started, std::stop_token& stop) const;

  replay::ReplaySource& source_;
  double speed_;
  double limit_s_;
  const Clock& clock_;
  std::atomic<double> played_s_{0.0};
};

}  // namespace edgesplat::app
