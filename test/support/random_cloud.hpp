// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "test/support/random.hpp"

#include <cstddef>

namespace edgesplat::test {

struct CloudShape {
  std::size_t count = 100;
  int sh_degree = 0;
  double half_width_m = 4.0;  ///< x and y in [-half, half], z in [near, far]
  double near_m = 1.0, far_m = 10.0;
  double scale_min_m = 0.01, scale_max_m = 0.3;  ///< of each axis
};

/// Gaussians in front of a camera at the origin of the map that looks along z.
[[nodiscard]] gaussian::GaussianCloud random_cloud(Random& random, const CloudShape& shape);

}  // namespace edgesplat::test
