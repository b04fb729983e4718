// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/livox_source.hpp"

namespace edgesplat::livox {

std::optional<sensor::Measurement> LivoxSource::on_points(std::span<const std::byte> datagram,
                                                          HostTime arrival) {
  const auto packet = decode_packet(datagram);
  if (!packet) {
    count(packet.error());
    return std::nullopt;
  }
  if (packet->type == DataType::kImu) {
    ++counters_.bad_type;
    return std::nullopt;
  }
  if (!points_.accept(*packet, arrival)) return std::nullopt;
  auto points = to_lidar_packet(*packet, arrival, filter_, counters_.dropped_points);
  counters_.points_out += points.points.size();
  return points;
}

std::optional<sensor::Measurement> LivoxSource::on_imu(std::span<const std::byte> datagram,
                                                       HostTime arrival) {
  const auto packet = decode_packet(datagram);
  if (!packet) {
    count(packet.error());
    return std::nullopt;
  }
  if (packet->type != DataType::kImu) {
    ++counters_.bad_type;
    return std::nullopt;
  }
  const auto sample = to_imu_sample(*packet, arrival);
  if (!sample) {
    ++counters_.bad_value;
    return std::nullopt;
  }
  if (!imu_.accept(*packet, arrival)) return std::nullopt;
  return *sample;
}

void LivoxSource::count(PacketFault fault) {
  switch (fault) {
    case PacketFault::kLength:
    case PacketFault::kDotCount:
      ++counters_.bad_length;
      break;
    case PacketFault::kVersion:
      ++counters_.bad_version;
      break;
    case PacketFault::kType:
      ++counters_.bad_type;
      break;
    case PacketFault::kCrc:
      ++counters_.bad_crc;
      break;
  }
}

LivoxCounters LivoxSource::counters() const {
  LivoxCounters all = counters_;
  all.points = points_.counters();
  all.imu = imu_.counters();
  return all;
}

}  // namespace edgesplat::livox
