// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"

#include <tl/expected.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace edgesplat::livox {

/// What a data packet carries (sensor-protocols sheet, 1.6).
enum class DataType : std::uint8_t {
  kImu = 0,          ///< one gyro + accelerometer record, 24 bytes
  kCartesianMm = 1,  ///< int32 millimetres, 14 bytes a point
  kCartesianCm = 2,  ///< int16 centimetres, 8 bytes a point
  kSphericalMm = 3,  ///< range and two angles, 10 bytes a point
};

/// Why a data packet was refused; each has its own counter.
enum class PacketFault : std::uint8_t {
  kLength,    ///< shorter than a header, or the length field is not the datagram's length
  kVersion,   ///< a protocol version this driver does not know
  kType,      ///< unknown data type
  kDotCount,  ///< the number of records does not fit the length
  kCrc,       ///< the checksum over stamp and records is wrong
  kStamp,     ///< SDK1: a date that does not exist
};
[[nodiscard]] std::string_view to_string(PacketFault fault);

inline constexpr std::size_t kPacketHeaderBytes = 36;
inline constexpr std::size_t kMaxPacketBytes = 1500;

/// When a packet was measured, and its number, if it has one: what its channel is watched by.
struct PacketTiming {
  sensor::StampSource stamp_source = sensor::StampSource::kFreeRunning;
  SensorTime stamp{};           ///< of the first record
  nanoseconds span{};           ///< first to last record
  bool is_numbered = true;      ///< SDK1's packets are not: losses show in the stamps alone
  nanoseconds period{};         ///< not numbered: from this packet to the next
  std::uint16_t udp_count = 0;  ///< +1 a packet; some scan patterns restart it with each frame
  std::uint8_t frame_count = 0;
};

/// A checked packet of SDK2; `records` borrows from the datagram.
struct DataPacket : PacketTiming {
  DataType type = DataType::kImu;
  std::uint16_t record_count = 0;
  std::span<const std::byte> records;
};

/// Checks one UDP payload of the points or the IMU channel. Never reads past the end, never allocates.
[[nodiscard]] tl::expected<DataPacket, PacketFault> decode_packet(std::span<const std::byte> datagram);

/// Which returns are let through. Each of the three tag fields (glued to a neighbour, rain or dust, other) is
/// 0 good, 1 medium, 2 low, 3 reserved.
struct PointFilter {
  std::uint8_t drop_confidence_from = 2;  ///< drop a point with a tag field this bad or worse, 1..4 (4: none)
};

/// Records that did not become points.
struct PointDrops {
  std::uint64_t no_return = 0;       ///< (0, 0, 0): nothing came back, blind zone or outside the window
  std::uint64_t low_confidence = 0;  ///< tag field >= drop_confidence_from
};

/// Records to points in metres. Point i was fired i * span / (N - 1) after the stamp; laser line is i mod 4.
/// Adds what it leaves out to `drops`. Precondition: packet.type is a point type.
[[nodiscard]] sensor::LidarPacket to_lidar_packet(const DataPacket& packet, HostTime arrival,
                                                  PointFilter filter, PointDrops& drops);
/// The record of an IMU packet (24 bytes, the same in SDK1 and SDK2) to SI units; nothing where a value is
/// not finite.
[[nodiscard]] std::optional<sensor::ImuSample> to_imu_sample(const PacketTiming& timing,
                                                             std::span<const std::byte> record,
                                                             HostTime arrival);

}  // namespace edgesplat::livox
