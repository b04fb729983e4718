// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/heartbeat.hpp"
#include "common/link/transport.hpp"
#include "common/map/keyframe.hpp"
#include "common/time/clock.hpp"
#include "robot/uplink/keyframe_sender.hpp"

#include <cstdint>
#include <functional>
#include <memory>

namespace edgesplat::uplink {

struct UplinkConfig : SenderConfig {
  std::size_t queue_keyframes = 32;  ///< waiting to be encoded, 1..1024; full: the oldest is dropped
  double heartbeat_period_s = 0.2;   ///< 0.05..10
};

struct UplinkCounters : SenderCounters {
  std::uint64_t submitted = 0;
  std::uint64_t dropped = 0;  ///< shed from the full queue, oldest first
  std::uint64_t heartbeats = 0;
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
  /// From the next keyframe on; what the link has not begun is spooled again where the mode goes down.
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
