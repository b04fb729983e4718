// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "common/time/time.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::simulate {

/// Points in every packet that a device sends.
inline constexpr std::size_t kPointsPerPacket = 96;

/// One point as the device sends it; all zero = no return.
struct WirePoint {
  std::int32_t x_mm = 0;
  std::int32_t y_mm = 0;
  std::int32_t z_mm = 0;
  std::uint8_t reflectivity = 0;  ///< 0..150 = 0..100 % diffuse, above: retroreflector
  std::uint8_t tag = 0;           ///< bits 0-1: glue between objects, 0 good .. 2 bad
};

/// What the device writes into a packet's header.
struct PacketStamp {
  std::uint16_t udp_cnt = 0;
  SensorTime first{};  ///< of the first point or the sample
  nanoseconds span{};  ///< first point to last point, 0 for the IMU
  sensor::StampSource source = sensor::StampSource::kPtp;
};

/// The device's side of the Livox data protocol (../shared/design/sensor-protocols.md 1.6), written apart
/// from the robot's driver so that each can prove the other wrong.
/// Cartesian points, type 1: 36 + 14 n bytes.
[[nodiscard]] std::vector<std::byte> encode_point_packet(const PacketStamp& stamp,
                                                         std::span<const WirePoint> points);
/// Type 0: rad/s and g.
[[nodiscard]] std::vector<std::byte> encode_imu_packet(const PacketStamp& stamp,
                                                       const Eigen::Vector3f& gyro_radps,
                                                       const Eigen::Vector3f& accel_g);

}  // namespace edgesplat::simulate
