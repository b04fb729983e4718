// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/heartbeat.hpp"
#include "common/link/transport.hpp"
#include "common/map/keyframe.hpp"
#include "common/time/clock.hpp"
#include "robot/uplink/keyframe_router.hpp"
#include "robot/uplink/spool.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

namespace edgesplat::uplink {

struct UplinkConfig {
  map::RobotId robot{1};                ///< 1..65535
  std::size_t queue_keyframes = 32;     ///< waiting to be encoded, 1..1024; full: the oldest is dropped
  double heartbeat_period_s = 0.2;      ///< 0.05..10
  std::size_t full_keyframe_bytes = 0;  ///< a keyframe is slimmed to about so much in FULL; 0: never
  std::size_t lean_keyframe_bytes = 0;  ///< and in LEAN
  RouterConfig router;
  SpoolConfig spool;
};

struct UplinkCounters {
  std::uint64_t submitted = 0;
  std::uint64_t dropped = 0;       ///< shed from the full queue, oldest first
  std::uint64_t refused = 0;       ///< cannot be encoded (not finite, too large), or refused by the transport
  std::uint64_t handed_on = 0;     ///< to the transport; what became of them: Transport::counters()
  std::uint64_t kept_by_mode = 0;  ///< put into the spool since the mode does not send them
  std::uint64_t kept_by_budget = 0;  ///< and since the mode's bytes a second were used up
  std::uint64_t encoded_bytes = 0;
  std::uint64_t heartbeats = 0;
  SpoolCounters spool;
};

/// Takes keyframes from the robot's threads and sends them to the server, as many as the mode says: all in
/// FULL, every third in LEAN, none in LOCAL. The others are spooled and sent when the link is idle and the
/// budget allows it. Encoding and sending happen on a thread of its own; the caller never waits for the
/// server, the network or the codec. Thread-safe.
class Uplink {
 public:
  /// Called on the uplink's thread for every heartbeat; may be empty.
  using HeartbeatSource = std::function<link::Heartbeat()>;

  /// `transport` and `clock` must outlive the uplink. Begins in FULL.
  Uplink(const UplinkConfig& config, link::Transport& transport, const Clock& clock,
         HeartbeatSource heartbeat = {});
  ~Uplink();
  Uplink(const Uplink&) = delete;
  Uplink& operator=(const Uplink&) = delete;

  /// Queues a keyframe and returns at once. False when it or an older one had to be dropped.
  bool submit(std::shared_ptr<const map::Keyframe> keyframe);
  /// From the next keyframe on.
  void set_mode(link::OffloadMode mode);
  /// Waits until all that was submitted, and all that was spooled, is encoded and acknowledged by the server,
  /// up to `timeout`; for the end of a run only. The budget of bytes does not hold here.
  bool drain(nanoseconds timeout);
  [[nodiscard]] UplinkCounters counters() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace edgesplat::uplink
