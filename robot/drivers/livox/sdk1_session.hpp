// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/drivers/livox/lidar_session.hpp"
#include "robot/drivers/livox/sdk1_command.hpp"

#include <cstdint>

namespace edgesplat::livox {

/// An Avia (SDK1): it announces itself once a second while nobody has it; handshake, settings (they are gone
/// after a restart), sampling, and a heartbeat every 0.8 s without which it drops the host after about 3 s.
/// Source: sensor-protocols sheet, 2.1, 2.7.
class Sdk1Session final : public LidarSession {
 public:
  Sdk1Session(LidarSessionConfig config, HostTowards host_towards)
      : LidarSession(std::move(config), std::move(host_towards), kPace) {}

  void on_control(Channel channel, const Endpoint& from, std::span<const std::byte> datagram,
                  HostTime now) override;
  /// Ends the session, so that the LiDAR announces itself at once to whoever comes next.
  void stop(HostTime now) override;

 private:
  enum class Phase : std::uint8_t { kSearching, kHandshake, kSettings, kSampling };
  static constexpr Pace kPace{std::chrono::milliseconds(500), std::chrono::seconds(1),
                              std::chrono::seconds(1)};

  [[nodiscard]] HostTime step_protocol(HostTime now) override;
  void search(HostTime now) override;
  void bring_up_again(HostTime now) override;
  void send_utc(std::int64_t utc_ns) override;
  [[nodiscard]] bool is_searching() const override { return phase_ == Phase::kSearching; }
  [[nodiscard]] bool is_sampling() const override { return phase_ == Phase::kSampling; }
  void become_searching() override { phase_ = Phase::kSearching; }

  void request(std::vector<std::byte> bytes, HostTime now) { ask(sequence_, std::move(bytes), now); }
  void on_announcement(const Sdk1Frame& frame, const Endpoint& from, HostTime now);
  void on_ack(const Sdk1Frame& frame, HostTime now);
  void on_heartbeat(const Sdk1Frame& frame);
  void shake_hands(HostTime now);
  void heartbeat(HostTime now);
  void begin_settings(HostTime now);
  /// Sends the next setting; after the last one it measures.
  void next_setting(HostTime now);
  void learn_status(std::uint32_t word);
  [[nodiscard]] bool in_session() const { return phase_ >= Phase::kSettings; }

  Phase phase_ = Phase::kSearching;
  std::uint16_t sequence_ = 0;
  std::size_t setting_ = 0;    ///< kSettings: which is under way
  HostTime next_heartbeat_{};  ///< in session
  int missed_heartbeats_ = 0;
  std::uint8_t last_system_status_ = 0;
};

}  // namespace edgesplat::livox
