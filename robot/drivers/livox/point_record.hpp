// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.hpp"
#include "common/sensor/measurement.hpp"
#include "robot/drivers/livox/livox_packet.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace edgesplat::livox {

inline constexpr double kStandardGravity_mps2 = 9.80665;  // the unit "g" of the IMU records

/// One return as it is on the wire.
struct RawPoint {
  Eigen::Vector3f p_m;
  bool has_return;
  std::uint8_t reflectivity;
  std::uint8_t tag;
};

/// Where a return is; has_return is false for (0, 0, 0): nothing came back.
struct RawPosition {
  Eigen::Vector3f p_m;
  bool has_return;
};

/// x, y, z as int32 millimetres, 12 bytes.
inline RawPosition read_millimetres(ByteReader& reader) {
  const auto x_mm = reader.read<std::int32_t>();
  const auto y_mm = reader.read<std::int32_t>();
  const auto z_mm = reader.read<std::int32_t>();
  // In double: float millimetres are not exact beyond 16.7 m.
  const Eigen::Vector3f p_m = (Eigen::Vector3d(x_mm, y_mm, z_mm) * 1e-3).cast<float>();
  return {p_m, (x_mm | y_mm | z_mm) != 0};
}

/// Zenith and azimuth in 0.01 degrees, 4 bytes.
struct RawDirection {
  std::uint16_t zenith;
  std::uint16_t azimuth;
};
inline RawDirection read_direction(ByteReader& reader) {
  const auto zenith = reader.read<std::uint16_t>();
  return {zenith, reader.read<std::uint16_t>()};
}
inline RawPosition to_position(std::uint32_t depth_mm, RawDirection direction) {
  constexpr double kRadPerStep = std::numbers::pi / 18000.0;
  const double zenith_rad = direction.zenith * kRadPerStep;
  const double azimuth_rad = direction.azimuth * kRadPerStep;
  const double range_m = depth_mm * 1e-3;
  const Eigen::Vector3d p_m(range_m * std::sin(zenith_rad) * std::cos(azimuth_rad),
                            range_m * std::sin(zenith_rad) * std::sin(azimuth_rad),
                            range_m * std::cos(zenith_rad));
  return {p_m.cast<float>(), depth_mm != 0};
}

/// When a return was fired, after the packet's stamp, and by which laser.
struct PlaceInPacket {
  std::int32_t offset_ns;
  std::uint8_t line;
};

/// Appends a return as a point, or counts why it is none. `confidence`: 0 good, 1 medium, 2 low.
inline void keep_point(const RawPoint& raw, std::uint8_t confidence, PlaceInPacket place, PointFilter filter,
                       PointDrops& drops, std::vector<sensor::LidarPoint>& points) {
  if (!raw.has_return) {
    ++drops.no_return;
    return;
  }
  if (confidence >= filter.drop_confidence_from) {
    ++drops.low_confidence;
    return;
  }
  sensor::LidarPoint& point = points.emplace_back();
  point.p_in_lidar_m = raw.p_m;
  point.reflectivity = static_cast<float>(raw.reflectivity) / 255.0F;
  point.offset_ns = place.offset_ns;
  point.line = place.line;
  point.noise_class = confidence == 0 ? std::uint8_t{0} : std::uint8_t{1};
}

}  // namespace edgesplat::livox
