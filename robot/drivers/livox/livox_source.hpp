// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "robot/drivers/livox/endpoint.hpp"
#include "robot/drivers/livox/livox_packet.hpp"
#include "robot/drivers/livox/sdk1_packet.hpp"
#include "robot/drivers/livox/stream_monitor.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace edgesplat::livox {

/// Everything the source saw; nothing is lost without being counted here.
struct LivoxCounters {
  StreamCounters points;
  StreamCounters imu;
  std::uint64_t bad_length = 0;  ///< PacketFault::kLength and kDotCount
  std::uint64_t bad_version = 0;
  std::uint64_t bad_type = 0;  ///< unknown type, or a type on the wrong channel
  std::uint64_t bad_crc = 0;
  std::uint64_t bad_value = 0;  ///< IMU record that is not finite, date that does not exist
  PointDrops dropped_points;
  std::uint64_t points_out = 0;  ///< points handed on
};

/// Datagrams of a Livox sensor to measurements. The same for a socket and a recording: whoever has bytes and
/// their arrival time feeds them here. A damaged packet is counted and never used. Thread-bound; the only
/// allocation is the vector of points.
class LivoxSource {
 public:
  /// `unit`: which of the rig's LiDARs it is, written on every packet.
  explicit LivoxSource(Protocol protocol = Protocol::kSdk2, PointFilter filter = {}, std::uint8_t unit = 0)
      : protocol_(protocol), filter_(filter), unit_(unit) {}

  /// One datagram of the point channel; a LidarPacket unless it was refused.
  [[nodiscard]] std::optional<sensor::Measurement> on_points(std::span<const std::byte> datagram,
                                                             HostTime arrival);
  /// One datagram of the IMU channel; an ImuSample unless it was refused.
  [[nodiscard]] std::optional<sensor::Measurement> on_imu(std::span<const std::byte> datagram,
                                                          HostTime arrival);
  [[nodiscard]] LivoxCounters counters() const;
  /// How often the clock of one channel got another source or started anew; cheap.
  [[nodiscard]] std::uint64_t clock_changes(Channel channel) const {
    return (channel == Channel::kImu ? imu_ : points_).counters().clock_changes;
  }
  /// What disciplines the LiDAR's clock, by its newest packet.
  [[nodiscard]] sensor::StampSource stamp_source() const { return stamp_source_; }

 private:
  [[nodiscard]] std::optional<sensor::Measurement> on_sdk1(std::span<const std::byte> datagram,
                                                           HostTime arrival, bool imu_channel);
  [[nodiscard]] std::optional<sensor::Measurement> accept_imu(const PacketTiming& timing,
                                                              std::span<const std::byte> record,
                                                              HostTime arrival);
  sensor::Measurement hand_on(sensor::LidarPacket points);
  void count(PacketFault fault);

  Protocol protocol_;
  PointFilter filter_;
  std::uint8_t unit_;
  StreamMonitor points_;
  StreamMonitor imu_;
  PulseTime pulses_;
  sensor::StampSource stamp_source_ = sensor::StampSource::kFreeRunning;
  LivoxCounters counters_;
};

}  // namespace edgesplat::livox
