// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/heartbeat.hpp"
#include "common/link/transport.hpp"
#include "robot/map/resident_map.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace edgesplat::test {

/// What the robot's program does with the link and its map, on one thread in virtual time.
class VirtualRobot {
 public:
  static constexpr map::RobotId kRobot{1};
  /// Called after each delta that changed the map.
  using OnApplied = std::function<void(const map::MapPosition&, std::uint64_t hash)>;

  VirtualRobot(link::Transport& transport, const Clock& clock, OnApplied on_applied)
      : transport_(transport), clock_(clock), on_applied_(std::move(on_applied)) {}

  void step() {
    while (const auto message = transport_.receive(nanoseconds(0))) take(*message);
    for (const auto& request : map_.requests(clock_.now()))
      (void)transport_.send(link::Lane::kRequest, kRobot, map::encode_map_request(request));
    if (clock_.now() < next_heartbeat_) return;
    next_heartbeat_ = clock_.now() + std::chrono::milliseconds(200);
    link::Heartbeat heartbeat;
    heartbeat.epoch = map_.position().epoch;
    heartbeat.seq = map_.position().seq;
    heartbeat.map_hash = map_.map_hash();
    (void)transport_.send(link::Lane::kHeartbeat, kRobot, link::encode_heartbeat(heartbeat));
  }
  /// An encoded keyframe.
  void send(std::vector<std::byte> keyframe) {
    ASSERT_TRUE(transport_.send(link::Lane::kKeyframe, kRobot, std::move(keyframe)));
  }
  [[nodiscard]] const map::ResidentMap& map() const { return map_; }

 private:
  void take(const link::Message& message) {
    if (message.lane == link::Lane::kDelta) {
      if (map_.apply(message.bytes, clock_.now()) == map::ApplyOutcome::kApplied)
        on_applied_(map_.position(), map_.map_hash());
      return;
    }
    const auto heartbeat = link::decode_heartbeat(message.bytes);
    ASSERT_TRUE(heartbeat);
    const bool idle = heartbeat->queued_messages == 0;
    if (heartbeat->epoch.value != 0)
      map_.server_at({heartbeat->epoch, heartbeat->seq}, heartbeat->map_hash, idle, clock_.now());
  }

  link::Transport& transport_;
  const Clock& clock_;
  const OnApplied on_applied_;
  map::ResidentMap map_{map::ResidentMapConfig{}};
  HostTime next_heartbeat_{};
};

}  // namespace edgesplat::test
