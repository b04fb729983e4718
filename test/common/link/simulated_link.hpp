// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/in_process_transport.hpp"

#include <algorithm>
#include <functional>

namespace edgesplat::link {

/// Two ends of a link in virtual time: everything between them is decided by the options and their seeds.
class SimulatedLink {
 public:
  static constexpr map::RobotId kRobot{1};

  explicit SimulatedLink(const LinkEndOptions& robot = {}, const LinkEndOptions& server = {},
                         double begin_s = 100.0)
      : clock(HostTime(from_seconds(begin_s))), ends_(make_in_process_ends(robot, server, clock)) {}

  [[nodiscard]] LinkEnd& robot() { return *ends_.robot; }
  [[nodiscard]] LinkEnd& server() { return *ends_.server; }

  /// Lets `seconds` pass; `each_ms`, where there is one, is called every millisecond.
  void run(double seconds, const std::function<void(double)>& each_ms = {}) {
    const HostTime begin = clock.now();
    const HostTime end = begin + from_seconds(seconds);
    HostTime next_call = begin;
    while (clock.now() < end) {
      if (each_ms && clock.now() >= next_call) {
        each_ms(to_seconds(clock.now() - begin));
        next_call += std::chrono::milliseconds(1);
      }
      nanoseconds sleep = std::min(ends_.robot->step(), ends_.server->step());
      sleep = std::min(sleep, ends_.robot->step());
      const nanoseconds least = std::chrono::microseconds(50);
      const nanoseconds most = std::chrono::milliseconds(1);
      clock.advance_to(clock.now() + std::clamp(sleep, least, most));
    }
  }

  VirtualClock clock;

 private:
  InProcessEnds ends_;
};

}  // namespace edgesplat::link
