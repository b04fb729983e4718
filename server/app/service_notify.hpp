// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <string>
#include <string_view>
#include <utility>

namespace edgesplat::app {

/// Tells systemd how the program does, one datagram a message to the socket in NOTIFY_SOCKET: the protocol of
/// sd_notify(3). Started by hand there is no socket, and nothing is sent. Thread-safe.
class ServiceNotify {
 public:
  /// `socket`: a path, or @name in the abstract namespace; empty: nobody listens.
  explicit ServiceNotify(std::string socket) : socket_(std::move(socket)) {}
  static ServiceNotify from_environment();

  [[nodiscard]] Status ready() const { return send("READY=1"); }
  /// To be sent more often than the unit's WatchdogSec, else the program is restarted.
  [[nodiscard]] Status watchdog() const { return send("WATCHDOG=1"); }
  [[nodiscard]] Status stopping() const { return send("STOPPING=1"); }

 private:
  /// Never waits. kInvalidArgument for a name that is no socket's, kIo with the system's reason.
  [[nodiscard]] Status send(std::string_view state) const;

  std::string socket_;
};

}  // namespace edgesplat::app
