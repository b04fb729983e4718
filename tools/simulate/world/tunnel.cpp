// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/noise.hpp"
#include "tools/simulate/world/curve.hpp"
#include "tools/simulate/world/places.hpp"

#include <cmath>
#include <numbers>

namespace edgesplat::simulate {
namespace {

/// A smooth vault along x, open at both ends, 60 m longer than the path on either side: nothing in it tells a
/// LiDAR how far along it is.
constexpr double kRadius_m = 3.2, kAxis_m = 1.6, kStart_m = -60.0, kEnd_m = 180.0, kPath_m = 120.0;

void add_vault(Scene& s, std::uint32_t seed) {
  Primitive vault;
  vault.shape = Shape::kTube;
  vault.centre_m = {(kStart_m + kEnd_m) / 2.0, 0.0, kAxis_m};
  vault.half_m = {kRadius_m, kRadius_m, (kEnd_m - kStart_m) / 2.0};
  Eigen::Matrix3d world_from_tube;  // local x up, local z along the tunnel
  world_from_tube << 0, 0, 1, 0, 1, 0, 1, 0, 0;
  world_from_tube.col(1) = world_from_tube.col(2).cross(world_from_tube.col(0));
  vault.rotate(world_from_tube);
  vault.material = s.add({Pattern::kTunnelWall,
                          {0.40F, 0.39F, 0.36F},
                          {0.60F, 0.38F, 0.03F},
                          25.0F,
                          0.14F,
                          0.45F,
                          seed,
                          0.0F,
                          static_cast<float>(std::numbers::pi * kRadius_m)});
  s.add(vault);
  const auto road = s.add({Pattern::kRoadMarks,
                           {0.13F, 0.13F, 0.13F},
                           {0.62F, 0.62F, 0.58F},
                           6.0F,
                           0.28F,
                           0.2F,
                           seed + 1,
                           0.0F,
                           3.0F});
  s.add_box({kStart_m, -3.0, -0.3}, {kEnd_m, 3.0, 0.0}, road);
  const auto earth =
      s.add({Pattern::kAsphalt, {0.20F, 0.19F, 0.13F}, Rgb::Zero(), 1.0F, 0.3F, 0.3F, seed + 2});
  s.add_box({-400, -60, -1.0}, {kStart_m, 60, -0.01}, earth);
  s.add_box({kEnd_m, -60, -1.0}, {400, 60, -0.01}, earth);
}

void add_lamps(Scene& s) {
  const auto glow = s.add({Pattern::kLamp, {0.97F, 0.92F, 0.78F}, Rgb::Ones(), 1.0F, 0.0F, 0.8F, 0, 0.95F});
  const double top_m = kAxis_m + kRadius_m;
  for (double x = kStart_m + 4.0; x < kEnd_m; x += 8.0) {
    // Flush with the vault's crown, so that they are seen but hardly felt.
    s.add_box({x - 0.7, -0.15, top_m - 0.03}, {x + 0.7, 0.15, top_m + 0.1}, glow);
    s.light.lamps.push_back({{x, 0.0, top_m - 0.04}, {0.7, 0.15}, Rgb(13.5F, 12.4F, 10.0F)});
  }
}

}  // namespace

Scene make_tunnel(std::uint64_t seed) {
  Scene s;
  add_vault(s, static_cast<std::uint32_t>(mix_bits(seed)));
  add_lamps(s);
  s.light.ambient_up = {0.30F, 0.285F, 0.25F};
  s.light.ambient_down = {0.38F, 0.36F, 0.31F};
  s.light.ambient_reach_m = 2.0;
  s.light.texel_m = 0.25;
  Polyline left, right;
  for (double x = 0.0; x <= kPath_m; x += 1.0)
    s.path.waypoints_m.push_back({x, 0.3 * std::sin(x / 9.0), 0.6});
  for (double x = -30.0; x <= kPath_m + 30.0; x += 1.0) {
    left.push_back({x, 1.25, 0.0});
    right.push_back({x, -1.25, 0.0});
  }
  s.path.speed_mps = 1.4;
  s.footways = {{left, false, -1.2}, {right, false, 0.9}};
  return s;
}

}  // namespace edgesplat::simulate
