// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/sdk1_packet.hpp"

#include "common/base/bytes.hpp"
#include "robot/drivers/livox/point_record.hpp"
#include "robot/drivers/livox/utc_date.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace edgesplat::livox {
namespace {

/// What is fixed for each data type.
struct Layout {
  std::uint16_t shots;  ///< in every packet
  std::uint16_t shot_bytes;
  int returns;  ///< of each shot
  bool spherical;
  bool tagged;
};
constexpr std::array<Layout, 9> kLayouts{{{100, 13, 1, false, false},
                                          {100, 9, 1, true, false},
                                          {96, 14, 1, false, true},
                                          {96, 10, 1, true, true},
                                          {48, 28, 2, false, true},
                                          {48, 16, 2, true, true},
                                          {1, 24, 0, false, false},
                                          {30, 42, 3, false, true},
                                          {30, 22, 3, true, true}}};
constexpr nanoseconds kImuPeriod = std::chrono::milliseconds(5);

/// The time of `shots` shots.
nanoseconds firing_time(int shots) {
  return nanoseconds(std::llround(shots * 1e9 / kAviaShotsPerSecond));
}

enum class TimeType : std::uint8_t { kSincePowerOn = 0, kPtp = 1, kReserved = 2, kUtc = 3, kSincePulse = 4 };

/// Reads the eight bytes of the stamp; false where they are no time.
bool read_stamp(std::uint8_t time_type, ByteReader& reader, Sdk1Packet& packet) {
  if (time_type > static_cast<std::uint8_t>(TimeType::kSincePulse)) return false;
  const auto type = static_cast<TimeType>(time_type);
  if (type == TimeType::kUtc) {
    UtcDate date;
    date.year = 2000 + reader.read<std::uint8_t>();
    date.month = reader.read<std::uint8_t>();
    date.day = reader.read<std::uint8_t>();
    date.hour = reader.read<std::uint8_t>();
    date.microsecond_of_hour = reader.read<std::uint32_t>();
    const auto stamp_ns = to_unix_ns(date);
    if (!stamp_ns) return false;
    packet.stamp = sensor_time_from_ns(*stamp_ns);
    packet.stamp_source = sensor::StampSource::kGps;
    return true;
  }
  // 62 bits reach to the year 2116; differences of such stamps cannot overflow.
  const auto stamp_ns = static_cast<std::int64_t>(reader.read<std::uint64_t>() & 0x3FFF'FFFF'FFFF'FFFFU);
  packet.stamp = sensor_time_from_ns(stamp_ns);
  packet.stamp_source =
      type == TimeType::kPtp ? sensor::StampSource::kPtp : sensor::StampSource::kFreeRunning;
  packet.since_pulse = type == TimeType::kSincePulse;
  return true;
}

/// Both noise fields of a tag as confidence of the point: 0 good, 1 medium, 2 low.
std::uint8_t confidence_of(std::uint8_t tag) {
  const auto field = [](unsigned bits) -> std::uint8_t { return bits == 0 ? 0 : (bits == 1 ? 2 : 1); };
  return std::max(field(tag & 3U), field((unsigned{tag} >> 2U) & 3U));
}

RawPoint read_return(const Layout& layout, RawDirection direction, ByteReader& reader) {
  const RawPosition position =
      layout.spherical ? to_position(reader.read<std::uint32_t>(), direction) : read_millimetres(reader);
  const auto reflectivity = reader.read<std::uint8_t>();
  return {position.p_m, position.has_return, reflectivity,
          layout.tagged ? reader.read<std::uint8_t>() : std::uint8_t{0}};
}

/// The single-return spherical types hold the depth before the angles.
RawPoint read_single_spherical(const Layout& layout, ByteReader& reader) {
  const auto depth_mm = reader.read<std::uint32_t>();
  const RawPosition position = to_position(depth_mm, read_direction(reader));
  const auto reflectivity = reader.read<std::uint8_t>();
  return {position.p_m, position.has_return, reflectivity,
          layout.tagged ? reader.read<std::uint8_t>() : std::uint8_t{0}};
}

}  // namespace

tl::expected<Sdk1Packet, PacketFault> decode_sdk1_packet(std::span<const std::byte> datagram) {
  if (datagram.size() < kSdk1HeaderBytes || datagram.size() > kMaxPacketBytes)
    return tl::unexpected(PacketFault::kLength);
  ByteReader reader(datagram);
  Sdk1Packet packet;
  packet.version = reader.read<std::uint8_t>();
  reader.skip(3);  // slot, LiDAR's number, reserved
  packet.status = reader.read<std::uint32_t>();
  const auto time_type = reader.read<std::uint8_t>();
  const auto type = reader.read<std::uint8_t>();
  if (type >= kLayouts.size()) return tl::unexpected(PacketFault::kType);
  packet.type = static_cast<Sdk1DataType>(type);
  if (!read_stamp(time_type, reader, packet)) return tl::unexpected(PacketFault::kStamp);
  packet.records = datagram.subspan(kSdk1HeaderBytes);
  const Layout& layout = kLayouts.at(type);
  if (packet.records.size() != std::size_t{layout.shots} * layout.shot_bytes)
    return tl::unexpected(PacketFault::kDotCount);
  packet.shot_count = layout.shots;
  packet.is_numbered = false;
  packet.span = firing_time(layout.shots - 1);
  packet.period = packet.type == Sdk1DataType::kImu ? kImuPeriod : firing_time(layout.shots);
  return packet;
}

sensor::LidarPacket to_lidar_packet(const Sdk1Packet& packet, HostTime arrival, PointFilter filter,
                                    PointDrops& drops) {
  const Layout& layout = kLayouts.at(static_cast<std::size_t>(packet.type));
  sensor::LidarPacket out;
  out.stamp = packet.stamp;
  out.arrival = arrival;
  out.stamp_source = packet.stamp_source;
  out.span = packet.span;
  out.points.reserve(static_cast<std::size_t>(layout.shots * layout.returns));
  ByteReader reader(packet.records);
  for (unsigned shot = 0; shot < layout.shots; ++shot) {
    const bool shares_direction = layout.spherical && layout.returns > 1;
    const RawDirection direction = shares_direction ? read_direction(reader) : RawDirection{};
    for (int i = 0; i < layout.returns; ++i) {
      const RawPoint raw = layout.spherical && !shares_direction ? read_single_spherical(layout, reader)
                                                                 : read_return(layout, direction, reader);
      const PlaceInPacket place{static_cast<std::int32_t>(firing_time(static_cast<int>(shot)).count()),
                                static_cast<std::uint8_t>(shot % kAviaLaserLines)};
      keep_point(raw, confidence_of(raw.tag), place, filter, drops, out.points);
    }
  }
  return out;
}

SensorTime PulseTime::unwrap(SensorTime since_pulse, HostTime arrival) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t phase_ns = to_ns(since_pulse);
  // Without pulses the count goes on beyond a second: then it is a time line already.
  std::int64_t stamp_ns = phase_ns;
  if (started_) {
    const double expected_ns =
        static_cast<double>(newest_ns_) + static_cast<double>((arrival - newest_arrival_).count());
    const double seconds = std::round((expected_ns - static_cast<double>(phase_ns)) / kSecond_ns);
    constexpr double kMost_s = 4e9;  // a century: beyond it the arrivals are no times
    stamp_ns = phase_ns + static_cast<std::int64_t>(std::clamp(seconds, 0.0, kMost_s)) * kSecond_ns;
  }
  started_ = true;
  newest_ns_ = stamp_ns;
  newest_arrival_ = arrival;
  return sensor_time_from_ns(stamp_ns);
}

}  // namespace edgesplat::livox
