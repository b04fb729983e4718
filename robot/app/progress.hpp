// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/clock.hpp"
#include "robot/tracking/tracked_group.hpp"

#include <cstdint>

namespace edgesplat::app {

/// With --json-progress: one JSON line a second on stdout about the newest pose. Thread-bound.
class Progress {
 public:
  Progress(bool enabled, const Clock& clock) : enabled_(enabled), clock_(clock) {}
  void on_pose(const tracking::TrackedGroup& group);

 private:
  bool enabled_;
  const Clock& clock_;
  bool started_ = false;
  HostTime first_stamp_{};
  HostTime last_line_{};
  std::int64_t poses_ = 0;
};

}  // namespace edgesplat::app
