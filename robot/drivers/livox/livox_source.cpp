// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/livox_source.hpp"

#include <utility>

namespace edgesplat::livox {

std::optional<sensor::Measurement> LivoxSource::on_points(std::span<const std::byte> datagram,
                                                          HostTime arrival) {
  if (protocol_ == Protocol::kSdk1) return on_sdk1(datagram, arrival, false);
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
  return hand_on(to_lidar_packet(*packet, arrival, filter_, counters_.dropped_points));
}

std::optional<sensor::Measurement> LivoxSource::on_imu(std::span<const std::byte> datagram,
                                                       HostTime arrival) {
  if (protocol_ == Protocol::kSdk1) return on_sdk1(datagram, arrival, true);
  const auto packet = decode_packet(datagram);
  if (!packet) {
    count(packet.error());
    return std::nullopt;
  }
  if (packet->type != DataType::kImu) {
    ++counters_.bad_type;
    return std::nullopt;
  }
  return accept_imu(*packet, packet->records, arrival);
}

std::optional<sensor::Measurement> LivoxSource::on_sdk1(std::span<const std::byte> datagram, HostTime arrival,
                                                        bool imu_channel) {
  auto packet = decode_sdk1_packet(datagram);
  if (!packet) {
    count(packet.error());
    return std::nullopt;
  }
  if ((packet->type == Sdk1DataType::kImu) != imu_channel) {
    ++counters_.bad_type;
    return std::nullopt;
  }
  if (packet->since_pulse) packet->stamp = pulses_.unwrap(packet->stamp, arrival);
  if (imu_channel) return accept_imu(*packet, packet->records, arrival);
  if (!points_.accept(*packet, arrival)) return std::nullopt;
  return hand_on(to_lidar_packet(*packet, arrival, filter_, counters_.dropped_points));
}

std::optional<sensor::Measurement> LivoxSource::accept_imu(const PacketTiming& timing,
                                                           std::span<const std::byte> record,
                                                           HostTime arrival) {
  const auto sample = to_imu_sample(timing, record, arrival);
  if (!sample) {
    ++counters_.bad_value;
    return std::nullopt;
  }
  if (!imu_.accept(timing, arrival)) return std::nullopt;
  return *sample;
}

sensor::Measurement LivoxSource::hand_on(sensor::LidarPacket points) {
  counters_.points_out += points.points.size();
  stamp_source_ = points.stamp_source;
  points.unit = unit_;
  return points;
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
    case PacketFault::kStamp:
      ++counters_.bad_value;
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
