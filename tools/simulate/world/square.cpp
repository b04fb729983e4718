// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/noise.hpp"
#include "tools/simulate/world/curve.hpp"
#include "tools/simulate/world/outdoors.hpp"
#include "tools/simulate/world/places.hpp"

#include <cmath>

namespace edgesplat::simulate {

/// Open ground and one wall, 8 m left of the path: little for a LiDAR to hold on to.
Scene make_square(std::uint64_t seed) {
  Scene s;
  const auto number = static_cast<std::uint32_t>(mix_bits(seed));
  const Fittings with = add_fittings(s, number + 100);
  const auto pavers =
      s.add({Pattern::kPavers, {0.42F, 0.40F, 0.37F}, {0.18F, 0.17F, 0.16F}, 0.8F, 0.2F, 0.35F, number});
  const auto bricks =
      s.add({Pattern::kBricks, {0.42F, 0.19F, 0.12F}, {0.46F, 0.43F, 0.39F}, 1.0F, 0.25F, 0.4F, number + 1});
  s.add_box({-250, -250, -0.5}, {250, 250, 0.0}, pavers);
  const Wall wall = make_wall({-30, 10}, {70, 10});
  add_on_wall(s, wall, {0.0, wall.length_m, 0.0, 3.2, -0.4, 0.0}, bricks);
  add_on_wall(s, wall, {-0.1, wall.length_m + 0.1, 3.2, 3.32, -0.5, 0.1}, with.frame);
  for (int i = 0; i < 30; ++i) {
    NoiseStream draw(seed, NoisePurpose::kPlace, static_cast<std::uint64_t>(i));
    const Spot spot{2.0 + 3.3 * i + draw.uniform(), static_cast<std::uint32_t>(draw.bits() >> 32U)};
    if (spot.seed % 3 != 0 && spot.middle_m < wall.length_m - 1.0) add_poster(s, wall, with, spot);
  }
  s.light.sun = Sun{Eigen::Vector3d(0.4, -0.5, 0.8).normalized(), {0.60F, 0.56F, 0.48F}};
  s.light.ambient_up = {0.34F, 0.38F, 0.45F};
  s.light.ambient_down = {0.22F, 0.21F, 0.19F};
  s.light.ambient_reach_m = 3.0;
  s.light.texel_m = 0.5;

  Polyline left, right;
  for (double x = 0.0; x <= 40.0; x += 0.5)
    s.path.waypoints_m.push_back({x, 2.0 + 1.2 * std::sin(x / 8.0), 0.6});
  for (double x = -15.0; x <= 55.0; x += 0.5) {
    left.push_back({x, 2.0 + 1.2 * std::sin(x / 8.0) + 1.3, 0.0});
    right.push_back({x, 2.0 + 1.2 * std::sin(x / 8.0) - 1.3, 0.0});
  }
  s.path.speed_mps = 1.3;
  s.footways = {{left, false, -1.2}, {right, false, 0.9}};
  return s;
}

}  // namespace edgesplat::simulate
