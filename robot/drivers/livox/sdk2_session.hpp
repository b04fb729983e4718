// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/drivers/livox/lidar_session.hpp"
#include "robot/drivers/livox/livox_command.hpp"
#include "robot/drivers/livox/sdk2_report.hpp"

namespace edgesplat::livox {

/// A Mid-360 (SDK2): discovery by broadcast once a second, its parameters read, those that differ written
/// (they go to the unit's flash), sampling, state pushes watched. Source: sensor-protocols sheet, 1.5.
class Sdk2Session final : public LidarSession {
 public:
  Sdk2Session(LidarSessionConfig config, HostTowards host_towards)
      : LidarSession(std::move(config), std::move(host_towards), kPace) {}

  void on_control(Channel channel, const Endpoint& from, std::span<const std::byte> datagram,
                  HostTime now) override;
  void stop(HostTime) override {}  // the unit goes on: the next start is quicker, others may listen

 private:
  enum class Phase : std::uint8_t { kSearching, kReading, kConfiguring, kStarting, kSampling };
  static constexpr Pace kPace{std::chrono::milliseconds(300), std::chrono::milliseconds(500), nanoseconds(0)};

  [[nodiscard]] HostTime step_protocol(HostTime now) override;
  void search(HostTime now) override;
  void bring_up_again(HostTime now) override { search_from(now); }
  void send_utc(std::int64_t utc_ns) override;
  [[nodiscard]] bool is_searching() const override { return phase_ == Phase::kSearching; }
  [[nodiscard]] bool is_sampling() const override { return phase_ == Phase::kSampling; }
  void become_searching() override { phase_ = Phase::kSearching; }

  void request(std::vector<std::byte> bytes, HostTime now) { ask(sequence_, std::move(bytes), now); }
  void read_parameters(HostTime now);
  void on_discovered(const CommandFrame& frame, HostTime now);
  void on_parameters(const ParameterReply& reply, HostTime now);
  void on_reply(const ParameterReply& reply, HostTime now);
  void on_push(const CommandFrame& frame, HostTime now);
  /// Writes what differs from what is wanted; false where nothing does.
  [[nodiscard]] bool configure(const std::vector<KeyValue>& values, HostTime now);
  void start(HostTime now);
  void begin_sampling(HostTime now);
  void learn_health(const Sdk2Report& report);
  [[nodiscard]] std::uint32_t next_sequence();

  Phase phase_ = Phase::kSearching;
  std::uint32_t sequence_ = 0;
  HostTime next_poll_{};       ///< kStarting
  HostTime start_deadline_{};  ///< kStarting
  bool was_rebooted_ = false;  ///< to take a setting: once
  bool told_no_firmware_ = false;
  Sdk2Report found_;  ///< by the last bring-up
  std::string last_faults_;
};

}  // namespace edgesplat::livox
