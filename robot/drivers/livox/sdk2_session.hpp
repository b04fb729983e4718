// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/drivers/livox/lidar_session.hpp"
#include "robot/drivers/livox/livox_command.hpp"
#include "robot/drivers/livox/pending_request.hpp"
#include "robot/drivers/livox/sdk2_report.hpp"

namespace edgesplat::livox {

/// A Mid-360 (SDK2): discovery by broadcast once a second, its parameters read, those that differ written
/// (they go to the unit's flash), sampling, state pushes watched. Source: sensor-protocols sheet, 1.5.
class Sdk2Session final : public LidarSession {
 public:
  using LidarSession::LidarSession;

  void on_control(Channel channel, const Endpoint& from, std::span<const std::byte> datagram,
                  HostTime now) override;
  void stop(HostTime) override {}  // the unit goes on: the next start is quicker, others may listen

 private:
  enum class Phase : std::uint8_t { kSearching, kReading, kConfiguring, kStarting, kSampling };

  [[nodiscard]] HostTime step_protocol(HostTime now) override;
  void on_silence(HostTime now) override;
  void send_utc(std::int64_t utc_ns) override;
  [[nodiscard]] bool is_sampling() const override { return phase_ == Phase::kSampling; }

  void search(HostTime now);
  void search_from(HostTime when);
  void request(std::vector<std::byte> bytes, HostTime now);
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
  PendingRequest pending_{std::chrono::milliseconds(300), 5};
  std::uint32_t sequence_ = 0;
  HostTime next_search_{};                 ///< kSearching
  HostTime next_poll_{};                   ///< kStarting
  HostTime start_deadline_{};              ///< kStarting
  HostTime next_rearm_ = HostTime::max();  ///< kSampling, while silent
  nanoseconds rearm_pause_ = std::chrono::seconds(1);
  bool was_rebooted_ = false;  ///< to take a setting: once
  bool told_no_firmware_ = false;
  Sdk2Report found_;  ///< by the last bring-up
  std::string last_faults_;
};

}  // namespace edgesplat::livox
