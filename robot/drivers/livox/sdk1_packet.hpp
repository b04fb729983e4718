// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/drivers/livox/livox_packet.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace edgesplat::livox {

/// What an SDK1 data packet carries (sensor-protocols sheet, 2.5).
enum class Sdk1DataType : std::uint8_t {
  kCartesian = 0,        ///< int32 mm and reflectivity, no tag
  kSpherical = 1,        ///< range and two angles, no tag
  kCartesianTagged = 2,  ///< what an Avia sends
  kSphericalTagged = 3,
  kDual = 4,  ///< two returns of each shot
  kDualSpherical = 5,
  kImu = 6,
  kTriple = 7,  ///< three returns of each shot
  kTripleSpherical = 8,
};

inline constexpr std::size_t kSdk1HeaderBytes = 18;
inline constexpr double kAviaShotsPerSecond = 240e3;
inline constexpr unsigned kAviaLaserLines = 6;

/// A checked packet; `records` borrows from the datagram. Its stamp is the first shot's; where only pulses
/// are connected it counts from the last pulse, see PulseTime.
struct Sdk1Packet : PacketTiming {
  Sdk1DataType type = Sdk1DataType::kImu;
  std::uint8_t version = 0;  ///< 5 so far; others are taken too
  bool since_pulse = false;  ///< the stamp starts anew each second
  std::uint32_t status = 0;  ///< see read_sdk1_status()
  std::uint16_t shot_count = 0;
  std::span<const std::byte> records;
};

/// Checks one UDP payload of the data or the IMU channel. The protocol has no checksum here: what is known of
/// each type, its exact length, is checked instead. Never reads past the end, never allocates. Span and
/// period are an Avia's (240 000 shots/s).
[[nodiscard]] tl::expected<Sdk1Packet, PacketFault> decode_sdk1_packet(std::span<const std::byte> datagram);

/// Records to points in metres, in firing order; the returns of one shot share its time and laser line
/// (shot mod 6). What the LiDAR itself calls noise with high confidence counts as confidence 2, moderate and
/// low as 1. Adds what it leaves out to `drops`. Precondition: packet.type is a point type.
[[nodiscard]] sensor::LidarPacket to_lidar_packet(const Sdk1Packet& packet, HostTime arrival,
                                                  PointFilter filter, PointDrops& drops);

/// Makes one time line of stamps that start anew with each pulse: the second is the one that fits the time
/// that passed here since the packet before. Counts from the first packet's pulse. Single-owner.
class PulseTime {
 public:
  [[nodiscard]] SensorTime unwrap(SensorTime since_pulse, HostTime arrival);

 private:
  bool started_ = false;
  std::int64_t newest_ns_ = 0;
  HostTime newest_arrival_{};
};

}  // namespace edgesplat::livox
