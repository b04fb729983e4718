// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/heartbeat.hpp"
#include "common/link/transport.hpp"
#include "common/map/keyframe.hpp"
#include "common/time/clock.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

namespace edgesplat::uplink {

struct UplinkConfig {
  map::RobotId robot{1};             ///< 1..65535
  std::size_t queue_keyframes = 32;  ///< waiting to be encoded, 1..1024; full: the oldest is dropped
  double heartbeat_period_s = 0.2;   ///< 0.05..10
};

struct UplinkCounters {
  std::uint64_t submitted = 0;
  std::uint64_t dropped = 0;    ///< shed from the full queue, oldest first
  std::uint64_t refused = 0;    ///< cannot be encoded (not finite, too large)
  std::uint64_t handed_on = 0;  ///< to the transport; what became of them: Transport::counters()
  std::uint64_t encoded_bytes = 0;
  std::uint64_t heartbeats = 0;
};

/// Takes keyframes from the robot's threads and sends them to the server. Encoding and sending happen on a
/// thread of its own; the caller never waits for the server, the network or the codec. Thread-safe.
class Uplink {
 public:
  /// Called on the uplink's thread for every heartbeat; may be empty.
  using HeartbeatSource = std::function<link::Heartbeat()>;

  /// `transport` and `clock` must outlive the uplink.
  Uplink(const UplinkConfig& config, link::Transport& transport, const Clock& clock,
         HeartbeatSource heartbeat = {});
  ~Uplink();
  Uplink(const Uplink&) = delete;
  Uplink& operator=(const Uplink&) = delete;

  /// Queues a keyframe and returns at once. False when it or an older one had to be dropped.
  bool submit(std::shared_ptr<const map::Keyframe> keyframe);
  /// Waits until all that was submitted is encoded and acknowledged by the server, up to `timeout`; for the
  /// end of a run only.
  bool drain(nanoseconds timeout);
  [[nodiscard]] UplinkCounters counters() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace edgesplat::uplink
