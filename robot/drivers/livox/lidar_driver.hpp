// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/time/clock.hpp"
#include "robot/drivers/livox/lidar_session.hpp"
#include "robot/drivers/livox/livox_source.hpp"
#include "robot/drivers/livox/livox_transport.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace edgesplat::livox {

/// Which LiDAR, and how far the robot goes with it.
enum class LidarChoice : std::uint8_t {
  kListen,  ///< takes what comes (SDK2), commands nothing
  kMid360,
  kAvia,
};

struct LidarDriverConfig {
  LidarChoice choice = LidarChoice::kListen;
  LivoxTransportConfig transport;       ///< its `control` follows `choice`
  std::string serial_number;            ///< the unit to use; empty: the first that answers
  std::uint8_t unit = 0;                ///< which of the rig's LiDARs
  std::vector<std::string> neighbours;  ///< serial numbers or addresses of the robot's other LiDARs
  bool has_imu = true;
  ReturnMode return_mode = ReturnMode::kFirst;  ///< kAvia
  bool feeds_utc =
      false;  ///< on a pulse-per-second line: told UTC, by this machine's clock at whole seconds ...
  bool sees_pulses = false;  ///< ... or, where its edges are captured, for each that on_pulse() reports
};

/// One LiDAR with everything it needs: sockets, session, packets to measurements. Thread-bound but for
/// on_pulse(): one thread calls step() again and again.
class LidarDriver {
 public:
  /// Who gets what; called from step().
  struct Outputs {
    std::function<void(sensor::Measurement)> measurement;
    std::function<void(const LidarEvent&)> event;
    std::function<void(const Datagram&)> datagram;  ///< as it came, for a recorder; may be empty
  };

  /// Errors: those of LivoxTransport::open. `clock` must outlive the driver.
  static Result<std::unique_ptr<LidarDriver>> open(const LidarDriverConfig& config, const Clock& clock,
                                                   Outputs outputs);

  /// Waits for datagrams, at most half a second, and handles what came and what is due. kIo.
  [[nodiscard]] Status step(const std::stop_token& stop);
  /// An edge of the pulse-per-second line at `edge`, which is `utc_ns` since 1970; from any thread, within
  /// 0.1 s.
  void on_pulse(HostTime edge, std::int64_t utc_ns);
  /// Lets the LiDAR go, where its protocol knows that.
  void stop();

  [[nodiscard]] const LivoxTransport& transport() const { return transport_; }
  [[nodiscard]] LivoxCounters source_counters() const { return source_.counters(); }
  /// Of a LiDAR that is only listened to: zeros.
  [[nodiscard]] LidarSessionCounters session_counters() const;
  [[nodiscard]] LidarHealth health() const { return session_ ? session_->health() : LidarHealth(); }
  /// Data from other senders than the LiDAR: not used.
  [[nodiscard]] std::uint64_t foreign_data() const { return foreign_data_; }
  [[nodiscard]] static Protocol protocol_of(LidarChoice choice) {
    return choice == LidarChoice::kAvia ? Protocol::kSdk1 : Protocol::kSdk2;
  }

 private:
  LidarDriver(const LidarDriverConfig& config, LivoxTransport transport, const Clock& clock, Outputs outputs);
  void handle(const Datagram& datagram, HostTime now);
  void watch_clock();
  void flush_session();
  void tell_time();

  const Clock& clock_;
  Outputs outputs_;
  LivoxTransport transport_;
  LivoxSource source_;
  std::unique_ptr<LidarSession> session_;  ///< empty: kListen
  HostTime next_step_{};
  bool step_is_due_ = true;
  std::uint64_t clock_changes_ = 0;
  std::uint64_t clock_restarts_ = 0;
  std::uint64_t foreign_data_ = 0;
  bool sees_pulses_ = false;
  struct Pulse {
    HostTime edge;
    std::int64_t utc_ns;
  };
  std::mutex pulse_mutex_;
  std::optional<Pulse> pulse_;  ///< the newest, not yet taken; under pulse_mutex_
};

}  // namespace edgesplat::livox
