// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace edgesplat::simulate {

enum class LidarKind : std::uint8_t {
  kMid360,  ///< 360 x 59 degrees, 200 000 points/s, 4 lines
  kAvia,    ///< 70.4 x 77.2 degrees, 240 000 points/s, 6 lines
};

/// Where a non-repetitive LiDAR looks with its n-th shot. Neither pattern closes within minutes, so coverage
/// grows with time.
///  * Mid-360: a mirror that nods fast (elevation, triangle) while it spins (azimuth, 10 Hz); the ratio of
///  the
///    two is irrational, so the phase precesses. Its four lines share the spin and are spread over one nod's
///    pitch.
///  * Avia: a rosette of two counter-rotating prisms of equal power (7294 and -4664 rpm, the figures
///  published
///    for this family), six lines stacked vertically.
struct LidarPattern {
  LidarKind kind = LidarKind::kMid360;

  [[nodiscard]] double shots_per_s() const { return kind == LidarKind::kMid360 ? 200e3 : 240e3; }
  [[nodiscard]] std::int64_t shot_period_ns() const;
  [[nodiscard]] unsigned lines() const { return kind == LidarKind::kMid360 ? 4U : 6U; }
  /// Laser line of a shot: they fire in turn.
  [[nodiscard]] unsigned line(std::uint64_t shot) const { return static_cast<unsigned>(shot % lines()); }
  /// Unit vector in the LiDAR's frame: x forward, y left, z up.
  [[nodiscard]] Eigen::Vector3d direction(std::uint64_t shot) const;
};

}  // namespace edgesplat::simulate
