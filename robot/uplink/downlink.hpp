// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/heartbeat.hpp"
#include "common/link/transport.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

namespace edgesplat::uplink {

/// What to do with what comes from the server; all are called on the downlink's own thread.
struct DownlinkHandlers {
  std::function<void(std::span<const std::byte>)> on_delta;
  std::function<void(const link::Heartbeat&)> on_heartbeat;
  std::function<void()> on_idle;  ///< nothing came for 50 ms
};

struct DownlinkCounters {
  std::uint64_t deltas = 0;
  std::uint64_t heartbeats = 0;
  std::uint64_t heartbeats_corrupt = 0;
};

/// Hands the server's messages to the robot's map, on a thread of its own. Thread-safe.
class Downlink {
 public:
  /// `transport` and what the handlers use must outlive the downlink.
  Downlink(link::Transport& transport, DownlinkHandlers handlers);
  ~Downlink();
  Downlink(const Downlink&) = delete;
  Downlink& operator=(const Downlink&) = delete;

  [[nodiscard]] DownlinkCounters counters() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace edgesplat::uplink
