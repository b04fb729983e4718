// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/livox_packet.hpp"

#include "common/base/bytes.hpp"
#include "robot/drivers/livox/checksum.hpp"
#include "robot/drivers/livox/point_record.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace edgesplat::livox {
namespace {

constexpr std::size_t kCheckedFrom = 28;  // the checksum covers the stamp and the records
constexpr std::uint16_t kLaserLines = 4;

std::size_t record_bytes(DataType type) {
  switch (type) {
    case DataType::kImu:
      return 24;
    case DataType::kCartesianMm:
      return 14;
    case DataType::kCartesianCm:
      return 8;
    case DataType::kSphericalMm:
      return 10;
  }
  return 0;
}

sensor::StampSource stamp_source_of(std::uint8_t time_type) {
  if (time_type == 1) return sensor::StampSource::kPtp;
  if (time_type == 2) return sensor::StampSource::kGps;
  return sensor::StampSource::kFreeRunning;
}

RawPoint finish(const RawPosition& position, ByteReader& reader) {
  const auto reflectivity = reader.read<std::uint8_t>();
  return {position.p_m, position.has_return, reflectivity, reader.read<std::uint8_t>()};
}

RawPosition read_centimetres(ByteReader& reader) {
  const auto x_cm = reader.read<std::int16_t>();
  const auto y_cm = reader.read<std::int16_t>();
  const auto z_cm = reader.read<std::int16_t>();
  return {(Eigen::Vector3d(x_cm, y_cm, z_cm) * 1e-2).cast<float>(), (x_cm | y_cm | z_cm) != 0};
}

RawPosition read_spherical(ByteReader& reader) {
  const auto depth_mm = reader.read<std::uint32_t>();
  return to_position(depth_mm, read_direction(reader));
}

RawPoint read_point(DataType type, ByteReader& reader) {
  if (type == DataType::kCartesianMm) return finish(read_millimetres(reader), reader);
  if (type == DataType::kCartesianCm) return finish(read_centimetres(reader), reader);
  return finish(read_spherical(reader), reader);
}

/// The worst of the three two-bit confidence fields.
std::uint8_t worst_confidence(std::uint8_t tag) {
  const unsigned bits = tag;
  return static_cast<std::uint8_t>(std::max({bits & 3U, (bits >> 2U) & 3U, (bits >> 4U) & 3U}));
}

}  // namespace

std::string_view to_string(PacketFault fault) {
  switch (fault) {
    case PacketFault::kLength:
      return "length";
    case PacketFault::kVersion:
      return "version";
    case PacketFault::kType:
      return "type";
    case PacketFault::kDotCount:
      return "dot_count";
    case PacketFault::kCrc:
      return "crc";
    case PacketFault::kStamp:
      return "stamp";
  }
  return "unknown";
}

tl::expected<DataPacket, PacketFault> decode_packet(std::span<const std::byte> datagram) {
  if (datagram.size() < kPacketHeaderBytes || datagram.size() > kMaxPacketBytes)
    return tl::unexpected(PacketFault::kLength);
  ByteReader reader(datagram);
  const auto version = reader.read<std::uint8_t>();
  if (version > 1) return tl::unexpected(PacketFault::kVersion);
  if (reader.read<std::uint16_t>() != datagram.size()) return tl::unexpected(PacketFault::kLength);
  DataPacket packet;
  packet.span = nanoseconds(std::int64_t{reader.read<std::uint16_t>()} * 100);
  packet.record_count = reader.read<std::uint16_t>();
  packet.udp_count = reader.read<std::uint16_t>();
  packet.frame_count = reader.read<std::uint8_t>();
  const auto type = reader.read<std::uint8_t>();
  if (type > static_cast<std::uint8_t>(DataType::kSphericalMm)) return tl::unexpected(PacketFault::kType);
  packet.type = static_cast<DataType>(type);
  packet.stamp_source = stamp_source_of(reader.read<std::uint8_t>());
  reader.skip(12);
  const auto stored_crc = reader.read<std::uint32_t>();
  const auto stamp_ns = reader.read<std::uint64_t>();
  packet.records = datagram.subspan(kPacketHeaderBytes);
  const bool one_if_imu = packet.type != DataType::kImu || packet.record_count == 1;
  if (!one_if_imu || packet.record_count * record_bytes(packet.type) != packet.records.size())
    return tl::unexpected(PacketFault::kDotCount);
  if (crc32(datagram.subspan(kCheckedFrom)) != stored_crc) return tl::unexpected(PacketFault::kCrc);
  // 62 bits reach to the year 2116; differences of such stamps cannot overflow.
  packet.stamp = sensor_time_from_ns(static_cast<std::int64_t>(stamp_ns & 0x3FFF'FFFF'FFFF'FFFFU));
  return packet;
}

sensor::LidarPacket to_lidar_packet(const DataPacket& packet, HostTime arrival, PointFilter filter,
                                    PointDrops& drops) {
  sensor::LidarPacket out;
  out.stamp = packet.stamp;
  out.arrival = arrival;
  out.stamp_source = packet.stamp_source;
  out.span = packet.span;
  out.points.reserve(packet.record_count);
  const std::int64_t gaps = std::max(1, packet.record_count - 1);
  ByteReader reader(packet.records);
  for (std::uint16_t i = 0; i < packet.record_count; ++i) {
    const RawPoint raw = read_point(packet.type, reader);
    const PlaceInPacket place{static_cast<std::int32_t>(packet.span.count() * i / gaps),
                              static_cast<std::uint8_t>(i % kLaserLines)};
    keep_point(raw, worst_confidence(raw.tag), place, filter, drops, out.points);
  }
  return out;
}

std::optional<sensor::ImuSample> to_imu_sample(const PacketTiming& timing, std::span<const std::byte> record,
                                               HostTime arrival) {
  ByteReader reader(record);
  std::array<float, 6> values{};
  for (float& value : values) value = reader.read<float>();
  if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }))
    return std::nullopt;
  sensor::ImuSample sample;
  sample.stamp = timing.stamp;
  sample.arrival = arrival;
  sample.stamp_source = timing.stamp_source;
  sample.gyro_radps = {values[0], values[1], values[2]};
  sample.accel_mps2 = Eigen::Vector3d(values[3], values[4], values[5]) * kStandardGravity_mps2;
  return sample;
}

}  // namespace edgesplat::livox
