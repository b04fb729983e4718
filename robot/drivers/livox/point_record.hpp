// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <numbers>

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

}  // namespace edgesplat::livox
