// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/lidar_pattern.hpp"

#include <cmath>
#include <numbers>

namespace edgesplat::simulate {
namespace {

using std::numbers::pi;
constexpr double kDegree = pi / 180.0;

double fraction(double x) {
  return x - std::floor(x);
}

Eigen::Vector3d mid360_direction(double time_s, unsigned line) {
  constexpr double kSpin_hz = 10.0;
  constexpr double kNod_hz = 10.0 * (35.0 + std::numbers::phi / 10.0);  // nods a turn: irrational
  constexpr double kLowest = -7.0 * kDegree, kHighest = 52.0 * kDegree;
  const double azimuth = 2.0 * pi * fraction(kSpin_hz * time_s);
  const double nod = fraction(kNod_hz * time_s + 0.25 * line);
  const double elevation = kLowest + (kHighest - kLowest) * std::abs(1.0 - 2.0 * nod);
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

Eigen::Vector3d avia_direction(double time_s, unsigned line) {
  constexpr double kFast_hz = 7294.0 / 60.0, kSlow_hz = -4664.0 / 60.0;
  constexpr double kHalfAngle = 35.2 * kDegree;       // of the rosette; lines widen it vertically
  constexpr double kLinePitch = 6.8 / 5.0 * kDegree;  // (77.2 - 70.4) degrees over five gaps
  const double fast = 2.0 * pi * fraction(kFast_hz * time_s);
  const double slow = 2.0 * pi * fraction(kSlow_hz * time_s);
  const double yaw = 0.5 * kHalfAngle * (std::cos(fast) + std::cos(slow));
  const double pitch =
      0.5 * kHalfAngle * (std::sin(fast) + std::sin(slow)) + (static_cast<double>(line) - 2.5) * kLinePitch;
  return {std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch)};
}

}  // namespace

std::int64_t LidarPattern::shot_period_ns() const {
  return kind == LidarKind::kMid360 ? 5000 : 4167;  // Avia: 1/240 kHz = 4166.7 ns
}

Eigen::Vector3d LidarPattern::direction(std::uint64_t shot) const {
  const double time_s = static_cast<double>(shot) * 1e-9 * static_cast<double>(shot_period_ns());
  return kind == LidarKind::kMid360 ? mid360_direction(time_s, line(shot))
                                    : avia_direction(time_s, line(shot));
}

}  // namespace edgesplat::simulate
