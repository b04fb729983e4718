// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/noise.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace edgesplat::simulate {

/// Reproducible points and directions for tests.
class RandomRays {
 public:
  explicit RandomRays(std::uint64_t seed) : draw_(seed, NoisePurpose::kPlace, 999) {}
  double uniform(double lo, double hi) { return lo + (hi - lo) * draw_.uniform(); }
  Eigen::Vector3d point(double reach_m) {
    const double x = uniform(-reach_m, reach_m), y = uniform(-reach_m, reach_m),
                 z = uniform(-reach_m, reach_m);
    return {x, y, z};
  }
  Eigen::Vector3d direction() {
    const double z = uniform(-1.0, 1.0), angle = uniform(0.0, 2.0 * std::numbers::pi);
    const double level = std::sqrt(1.0 - z * z);
    return {level * std::cos(angle), level * std::sin(angle), z};
  }

 private:
  NoiseStream draw_;
};

}  // namespace edgesplat::simulate
