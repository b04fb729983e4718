// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/noise.hpp"
#include "tools/simulate/world/curve.hpp"
#include "tools/simulate/world/outdoors.hpp"
#include "tools/simulate/world/places.hpp"

#include <cmath>

namespace edgesplat::simulate {
namespace {

/// Along x: lanes for cars at y = +-1.6, parked cars at +-4.15, kerbs at +-5.3, fronts at +-9.3. The robot
/// drives on the right-hand pavement.
constexpr double kStart_m = -24.0, kEnd_m = 126.0, kFront_m = 9.3, kKerb_m = 5.3, kKerbHeight_m = 0.12;
constexpr double kRobot_y_m = -7.2, kLaneOffset_m = 0.85;

void add_ground(Scene& s, std::uint32_t seed) {
  const auto road = s.add({Pattern::kRoadMarks,
                           {0.11F, 0.11F, 0.115F},
                           {0.62F, 0.62F, 0.60F},
                           5.0F,
                           0.28F,
                           0.2F,
                           seed,
                           0.0F,
                           static_cast<float>(kKerb_m)});
  const auto pavers =
      s.add({Pattern::kPavers, {0.40F, 0.38F, 0.35F}, {0.17F, 0.16F, 0.15F}, 0.4F, 0.2F, 0.35F, seed + 1});
  const auto kerb =
      s.add({Pattern::kConcrete, {0.46F, 0.45F, 0.43F}, {0.2F, 0.2F, 0.2F}, 1.0F, 0.18F, 0.4F, seed + 2});
  s.add_box({-70, -kKerb_m, -0.3}, {170, kKerb_m, 0.0}, road);
  for (const double side : {-1.0, 1.0}) {
    const double near = side * (kKerb_m + 0.15), far = side * (kFront_m + 1.0), edge = side * kKerb_m;
    s.add_box({-70, std::min(near, far), -0.3}, {170, std::max(near, far), kKerbHeight_m}, pavers);
    s.add_box({-70, std::min(edge, near), -0.3}, {170, std::max(edge, near), kKerbHeight_m + 0.005}, kerb);
  }
}

void add_houses(Scene& s, const Fittings& with, std::uint64_t seed) {
  for (const bool left : {false, true}) {
    NoiseStream draw(seed, NoisePurpose::kPlace, left ? 1 : 2);
    double x = kStart_m;
    while (x < kEnd_m) {
      const double length_m = std::min(8.5 + 6.0 * draw.uniform(), kEnd_m + 14.0 - x);
      const double y = (left ? kFront_m : -kFront_m) + 0.35 * (draw.uniform() - 0.5) * (left ? 1.0 : -1.0);
      Wall wall = left ? make_wall({x, y}, {x + length_m, y}) : make_wall({x + length_m, y}, {x, y});
      wall.foot_m = kKerbHeight_m;
      add_house(s, wall, with, static_cast<std::uint32_t>(draw.bits() >> 32U));
      x += length_m;
    }
  }
  // An arch at either end closes the street; cars come and go through it.
  const auto stone =
      s.add({Pattern::kBricks, {0.42F, 0.30F, 0.20F}, {0.4F, 0.38F, 0.35F}, 1.0F, 0.25F, 0.4F, 91});
  for (const double x : {kStart_m, kEnd_m}) {
    s.add_box({x - 3.0, -kFront_m - 0.4, 4.6}, {x + 3.0, kFront_m + 0.4, 13.0}, stone);
    for (const double side : {-1.0, 1.0})
      s.add_box({x - 3.0, side > 0 ? kKerb_m : -kFront_m - 0.4, 0.0},
                {x + 3.0, side > 0 ? kFront_m + 0.4 : -kKerb_m, 4.6}, stone);
  }
}

void add_furniture(Scene& s, const Fittings& with, std::uint64_t seed) {
  NoiseStream draw(seed, NoisePurpose::kPlace, 3);
  const auto number = [&] { return static_cast<std::uint32_t>(draw.bits() >> 32U); };
  for (const double side : {-1.0, 1.0}) {
    const double row = side * (kKerb_m + 0.5);
    int place = 0;
    for (double x = -18.0 + 2.0 * draw.uniform(); x < 120.0; x += 6.5 + 1.5 * draw.uniform(), ++place) {
      const Eigen::Vector3d foot(x, row, kKerbHeight_m);
      switch (place % 4) {
        case 0:
        case 2:
          add_tree(s, foot, number());
          break;
        case 1:
          add_street_lamp(s, foot, -side * 1.4, with.steel);
          break;
        default:
          s.add_pillar(foot, 0.19, 0.85, with.dark);  // a bin and bollards
          for (const double next : {1.2, 2.4})
            s.add_pillar(foot + Eigen::Vector3d(next, -0.2 * side, 0), 0.06, 0.95, with.steel);
          break;
      }
    }
    for (double x = -17.0 + 3.0 * draw.uniform(); x < 118.0; x += 5.1 + 0.5 * draw.uniform()) {
      const bool taken = draw.uniform() < 0.68, turned = draw.uniform() < 0.2;
      const std::uint64_t look = draw.bits();
      const Eigen::Vector2d forward(side < 0 ? 1.0 : -1.0, 0.0);
      if (taken) add_parked_car(s, {x, side * 4.15, 0.0}, turned ? Eigen::Vector2d(-forward) : forward, look);
    }
  }
}

}  // namespace

Scene make_street(std::uint64_t seed) {
  Scene s;
  const auto number = static_cast<std::uint32_t>(mix_bits(seed));
  const Fittings with = add_fittings(s, number + 100);
  add_ground(s, number);
  add_houses(s, with, seed);
  add_furniture(s, with, seed);
  s.light.sun = Sun{Eigen::Vector3d(0.35, 0.55, 0.9).normalized(), {0.80F, 0.74F, 0.62F}};
  s.light.ambient_up = {0.42F, 0.46F, 0.53F};
  s.light.ambient_down = {0.28F, 0.27F, 0.25F};
  s.light.ambient_reach_m = 3.0;
  s.light.texel_m = 0.2;

  Polyline right, left, far_right, far_left;
  for (double x = 0.0; x <= 100.0; x += 0.5)
    s.path.waypoints_m.push_back({x, kRobot_y_m + 0.25 * std::sin(x / 7.0), kKerbHeight_m + 0.6});
  s.path.speed_mps = 1.4;
  for (double x = -20.0; x <= 122.0; x += 0.5) {
    const double y = kRobot_y_m + 0.25 * std::sin(x / 7.0);
    right.push_back({x, y - kLaneOffset_m, kKerbHeight_m});
    left.push_back({x, y + kLaneOffset_m, kKerbHeight_m});
    far_right.push_back({x, 6.7, kKerbHeight_m});
    far_left.push_back({x, 7.9, kKerbHeight_m});
  }
  s.footways = {{left, false, -1.2}, {right, false, 0.95}, {far_right, false, 1.1}, {far_left, false, -1.25}};
  s.roads = {{{{-60, -1.6, 0}, {160, -1.6, 0}}, false, 6.0}, {{{-60, 1.6, 0}, {160, 1.6, 0}}, false, -7.0}};
  return s;
}

}  // namespace edgesplat::simulate
