// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <thread>

namespace edgesplat::thread {

/// Turns SIGINT and SIGTERM into a stop request, so that a program ends in its own time. Create it first in
/// main(), before any other thread: the signals are blocked in every thread started after it. One a process.
/// A second signal ends the process at once, in case the clean end hangs.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }
  /// Asks for the same stop from inside the program.
  void request_stop() { source_.request_stop(); }

 private:
  std::stop_source source_;
  std::jthread waiter_;
};

}  // namespace edgesplat::thread
