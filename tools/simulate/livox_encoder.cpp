// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/livox_encoder.hpp"

#include "common/base/bytes.hpp"

#include <zlib.h>

namespace edgesplat::simulate {
namespace {

constexpr std::uint8_t kImuData = 0;
constexpr std::uint8_t kCartesianData = 1;
constexpr std::size_t kLengthAt = 1;
constexpr std::size_t kChecksumAt = 24;
constexpr std::size_t kChecksummedFrom = 28;  // the time stamp and the records

std::uint8_t time_type(sensor::StampSource source) {
  switch (source) {
    case sensor::StampSource::kFreeRunning:
      return 0;
    case sensor::StampSource::kPtp:
      return 1;
    case sensor::StampSource::kGps:
      return 2;
  }
  return 0;
}

ByteWriter begin_packet(const PacketStamp& stamp, std::uint8_t data_type, std::size_t records) {
  ByteWriter packet;
  packet.write<std::uint8_t>(0);                                            // version
  packet.write<std::uint16_t>(0);                                           // length, patched
  packet.write(static_cast<std::uint16_t>(stamp.span / nanoseconds(100)));  // time_interval
  packet.write(static_cast<std::uint16_t>(records));                        // dot_num
  packet.write(stamp.udp_cnt);
  packet.write<std::uint8_t>(0);  // frame_cnt: not valid for non-repetitive scanning
  packet.write(data_type);
  packet.write(time_type(stamp.source));
  for (int i = 0; i < 12; ++i) packet.write<std::uint8_t>(0);
  packet.write<std::uint32_t>(0);  // crc32, patched
  packet.write(static_cast<std::uint64_t>(to_ns(stamp.first)));
  return packet;
}

std::vector<std::byte> finish_packet(ByteWriter packet) {
  packet.patch(kLengthAt, static_cast<std::uint16_t>(packet.size()));
  const auto checked = packet.bytes().subspan(kChecksummedFrom);
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  packet.patch(kChecksumAt, static_cast<std::uint32_t>(sum));
  return packet.take();
}

}  // namespace

std::vector<std::byte> encode_point_packet(const PacketStamp& stamp, std::span<const WirePoint> points) {
  ByteWriter packet = begin_packet(stamp, kCartesianData, points.size());
  for (const WirePoint& point : points) {
    packet.write(point.x_mm);
    packet.write(point.y_mm);
    packet.write(point.z_mm);
    packet.write(point.reflectivity);
    packet.write(point.tag);
  }
  return finish_packet(std::move(packet));
}

std::vector<std::byte> encode_imu_packet(const PacketStamp& stamp, const Eigen::Vector3f& gyro_radps,
                                         const Eigen::Vector3f& accel_g) {
  ByteWriter packet = begin_packet(stamp, kImuData, 1);
  for (const Eigen::Vector3f& v : {gyro_radps, accel_g}) {
    for (int axis = 0; axis < 3; ++axis) packet.write(v[axis]);
  }
  return finish_packet(std::move(packet));
}

}  // namespace edgesplat::simulate
