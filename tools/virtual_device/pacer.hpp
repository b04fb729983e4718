// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <cstdint>
#include <stop_token>

namespace edgesplat::virtual_device {

/// Plays recorded times against the steady clock: sleeps until the moment of each message, never spins.
/// Lateness does not add up, as every deadline counts from the start. Single-owner.
class Pacer {
 public:
  /// `speed` 2 = twice as fast, > 0. The first wait_for() starts the clock and returns at once.
  explicit Pacer(double speed) : speed_(speed) {}

  /// Returns at the moment of `recorded`, or early (false) when a stop is requested.
  bool wait_for(HostTime recorded, const std::stop_token& stop);
  /// Moments met more than 5 ms late.
  [[nodiscard]] std::uint64_t late() const { return late_; }
  [[nodiscard]] nanoseconds most_late() const { return most_late_; }

 private:
  double speed_;
  bool started_ = false;
  HostTime first_recorded_{};
  std::int64_t start_ns_ = 0;
  std::uint64_t late_ = 0;
  nanoseconds most_late_{};
};

}  // namespace edgesplat::virtual_device
