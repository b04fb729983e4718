// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/dds_transport.hpp"
#include "robot/map/resident_map.hpp"
#include "robot/uplink/downlink.hpp"
#include "robot/uplink/uplink.hpp"

#include <condition_variable>
#include <memory>
#include <mutex>

namespace edgesplat::test {

/// The robot's half of the link as the robot's program wires it, for tests against a server.
class RobotEnd {
 public:
  static constexpr map::RobotId kRobot{1};

  explicit RobotEnd(std::shared_ptr<link::DdsDomain> domain)
      : transport_(*link::open_dds_transport(std::move(domain), {link::Role::kRobot, kRobot, 0}, clock_)),
        uplink_(uplink::UplinkConfig{}, *transport_, clock_),
        downlink_(*transport_, {[this](std::span<const std::byte> bytes) { on_delta(bytes); },
                                [this](const link::Heartbeat& heartbeat) { on_heartbeat(heartbeat); },
                                [this] {
                                  map_.publish_if_due(clock_.now());
                                  send_requests();
                                }}) {}

  [[nodiscard]] uplink::Uplink& uplink() { return uplink_; }
  [[nodiscard]] const map::ResidentMap& map() const { return map_; }
  [[nodiscard]] link::Transport& transport() { return *transport_; }
  [[nodiscard]] const Clock& clock() const { return clock_; }

  /// Waits until delta `seq` of `epoch` (or a newer one) is applied.
  bool wait_for_delta(map::Epoch epoch, std::uint64_t seq, std::chrono::seconds patience) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, patience, [&] {
      const auto at = map_.position();
      return at.epoch == epoch && at.seq >= seq;
    });
  }
  /// The server's newest.
  [[nodiscard]] link::Heartbeat server_heartbeat() {
    const std::lock_guard lock(mutex_);
    return server_;
  }
  /// Waits for a heartbeat of the server that speaks of delta `seq`; its map hash.
  std::optional<std::uint64_t> server_hash_at(std::uint64_t seq, std::chrono::seconds patience) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, patience, [&] { return server_.seq == seq; })) return std::nullopt;
    return server_.map_hash;
  }

 private:
  void send_requests() {
    for (const map::MapRequest& request : map_.requests(clock_.now()))
      (void)transport_->send(link::Lane::kRequest, kRobot, map::encode_map_request(request));
  }
  void on_delta(std::span<const std::byte> bytes) {
    (void)map_.apply(bytes, clock_.now());
    send_requests();
    const std::lock_guard lock(mutex_);
    changed_.notify_all();
  }
  void on_heartbeat(const link::Heartbeat& heartbeat) {
    const bool idle = heartbeat.queued_messages == 0;
    if (heartbeat.epoch.value != 0)
      map_.server_at({heartbeat.epoch, heartbeat.seq}, heartbeat.map_hash, idle, clock_.now());
    send_requests();
    const std::lock_guard lock(mutex_);
    server_ = heartbeat;
    changed_.notify_all();
  }

  SteadyClock clock_;
  map::ResidentMap map_{map::ResidentMapConfig{}};
  std::mutex mutex_;
  std::condition_variable changed_;
  link::Heartbeat server_;
  std::unique_ptr<link::Transport> transport_;
  uplink::Uplink uplink_;
  uplink::Downlink downlink_;
};

}  // namespace edgesplat::test
