// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/rigid_transform.hpp"
#include "common/geometry/so3.hpp"

#include <cstdint>
#include <random>

namespace edgesplat::test {

/// Seeded source of test data: the same numbers on every machine (no std::*_distribution, whose results are
/// up to the library).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [low, high).
  double uniform(double low = 0.0, double high = 1.0) {
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1.0p-53;
  }
  /// Normal with mean 0 and standard deviation 1 (Box and Muller).
  double normal();
  /// Exponential with the given mean.
  double exponential(double mean);
  /// In [0, count).
  std::uint64_t below(std::uint64_t count) { return engine_() % count; }

  Eigen::Vector3d vector(double half_width) {
    return {uniform(-half_width, half_width), uniform(-half_width, half_width),
            uniform(-half_width, half_width)};
  }
  Eigen::Vector3d direction();
  Eigen::Quaterniond rotation() { return geometry::so3_exp(uniform(0.0, 3.14159) * direction()); }
  geometry::RigidTransform transform(double half_width_m = 10.0) {
    return {rotation(), vector(half_width_m)};
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace edgesplat::test
