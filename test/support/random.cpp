// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/support/random.hpp"

#include <cmath>
#include <numbers>

namespace edgesplat::test {

double Random::normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

double Random::exponential(double mean) {
  return -mean * std::log(1.0 - uniform());
}

Eigen::Vector3d Random::direction() {
  for (;;) {
    const Eigen::Vector3d v = vector(1.0);
    if (v.squaredNorm() > 1e-4 && v.squaredNorm() <= 1.0) return v.normalized();
  }
}

}  // namespace edgesplat::test
