// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/noise.hpp"
#include "tools/simulate/world/curve.hpp"
#include "tools/simulate/world/places.hpp"
#include "tools/simulate/world/wall.hpp"

#include <array>

namespace edgesplat::simulate {
namespace {

/// The centre line is a rectangle; walls stand 1.5 m to either side of it. People keep 0.8 m off it, which
/// leaves them 0.25 m from furniture and 0.5 m from the robot's middle.
struct Ring {
  double length_m;
  double depth_m;
};
constexpr double kHalfWidth_m = 1.5, kHeight_m = 2.8;
constexpr double kLaneOffset_m = 0.8;
constexpr double kCornerReach_m = 1.0;  ///< corners of the waypoints are means over this reach
/// A mean over this reach rounds corners as tools/simulate/route.hpp does (a Gaussian of 0.6 m has its
/// variance).
constexpr double kRouteReach_m = 1.04;

std::uint32_t plaster(Scene& s, const Rgb& colour, float contrast, std::uint32_t seed) {
  return s.add({Pattern::kPlaster, colour, colour, 1.0F, contrast, 0.2F + 0.7F * colour.mean(), seed});
}

/// Floor in four kinds, ceiling in panels.
void add_floor_and_ceiling(Scene& s, const Ring& ring, std::uint32_t seed) {
  constexpr double kOut = kHalfWidth_m + 0.3;
  const auto terrazzo =
      s.add({Pattern::kTiles, {0.42F, 0.40F, 0.37F}, {0.16F, 0.15F, 0.14F}, 0.6F, 0.16F, 0.35F, seed});
  const auto slate =
      s.add({Pattern::kTiles, {0.24F, 0.25F, 0.26F}, {0.10F, 0.10F, 0.10F}, 0.45F, 0.18F, 0.25F, seed + 1});
  const auto parquet =
      s.add({Pattern::kWood, {0.40F, 0.25F, 0.13F}, {0.12F, 0.07F, 0.04F}, 0.14F, 0.25F, 0.45F, seed + 2});
  const double x1 = ring.length_m + kOut, y1 = ring.depth_m + kOut;
  s.add_box({-kOut, -kOut, -0.2}, {x1, kHalfWidth_m, 0.0}, terrazzo);
  s.add_box({ring.length_m - kHalfWidth_m, kHalfWidth_m, -0.2}, {x1, ring.depth_m - kHalfWidth_m, 0.0},
            parquet);
  s.add_box({-kOut, ring.depth_m - kHalfWidth_m, -0.2}, {x1, y1, 0.0}, slate);
  s.add_box({-kOut, kHalfWidth_m, -0.2}, {kHalfWidth_m, ring.depth_m - kHalfWidth_m, 0.0}, terrazzo);
  const auto panels =
      s.add({Pattern::kTiles, {0.72F, 0.72F, 0.70F}, {0.38F, 0.38F, 0.37F}, 0.6F, 0.05F, 0.8F, seed + 3});
  s.add_box({-kOut, -kOut, kHeight_m}, {x1, y1, kHeight_m + 0.2}, panels);
}

/// Walls in the order in which the robot passes them, right of it first: outer, inner, of each side.
std::array<Wall, 8> corridor_walls(const Ring& ring) {
  constexpr double kOut = kHalfWidth_m;
  const double x0 = -kOut, x1 = ring.length_m + kOut, y0 = -kOut, y1 = ring.depth_m + kOut;
  const double in_x0 = kOut, in_x1 = ring.length_m - kOut, in_y0 = kOut, in_y1 = ring.depth_m - kOut;
  return {make_wall({x1, y0}, {x0, y0}), make_wall({in_x0, in_y0}, {in_x1, in_y0}),
          make_wall({x1, y1}, {x1, y0}), make_wall({in_x1, in_y0}, {in_x1, in_y1}),
          make_wall({x0, y1}, {x1, y1}), make_wall({in_x1, in_y1}, {in_x0, in_y1}),
          make_wall({x0, y0}, {x0, y1}), make_wall({in_x0, in_y1}, {in_x0, in_y0})};
}

void add_wall_surfaces(Scene& s, const std::array<Wall, 8>& walls, const Fittings& with, std::uint32_t seed) {
  const std::array<std::uint32_t, 8> paint{
      plaster(s, {0.70F, 0.68F, 0.62F}, 0.03F, seed + 10),
      plaster(s, {0.72F, 0.70F, 0.66F}, 0.03F, seed + 11),
      plaster(s, {0.68F, 0.66F, 0.60F}, 0.03F, seed + 12),
      s.add({Pattern::kBricks, {0.40F, 0.17F, 0.11F}, {0.48F, 0.45F, 0.41F}, 1.0F, 0.25F, 0.4F, seed + 13}),
      plaster(s, {0.66F, 0.67F, 0.66F}, 0.03F, seed + 14),
      plaster(s, {0.55F, 0.40F, 0.16F}, 0.05F, seed + 15),
      plaster(s, {0.70F, 0.68F, 0.63F}, 0.03F, seed + 16),
      plaster(s, {0.20F, 0.38F, 0.40F}, 0.05F, seed + 17)};
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Wall& wall = walls[i];
    // Outer walls reach past the corners behind each other; inner ones along x own the corners.
    const double past = i % 2 == 0 ? 0.2 : i % 4 == 3 ? -0.2 : 0.0;
    add_on_wall(s, wall, {-past, wall.length_m + past, 0.0, kHeight_m, -0.2, 0.0}, paint[i]);
    add_on_wall(s, wall, {0.0, wall.length_m, 0.0, 0.09, 0.0, 0.012}, with.dark);  // skirting
  }
}

/// What stands in one stretch of wall. Bare stretches are left on purpose: real corridors have them.
void furnish_stretch(Scene& s, const Wall& wall, const Fittings& with, const Spot& spot, bool to_outside) {
  const Spot left{spot.middle_m - 0.85, spot.seed + 1}, right{spot.middle_m + 0.85, spot.seed + 2};
  switch (spot.seed % 9) {
    case 0:
    case 1:
      if (to_outside) return add_inside_window(s, wall, with, spot);
      add_door(s, wall, with, left);
      return add_poster(s, wall, with, {right.middle_m + 0.1, right.seed});
    case 2:
      return add_board(s, wall, with, spot);
    case 3:
      add_pillar(s, wall, with, left);
      return to_outside ? add_plant(s, wall, with, right) : add_extinguisher(s, wall, with, right);
    case 4:
      add_bench(s, wall, with, spot);
      add_poster(s, wall, with, {spot.middle_m - 0.5, spot.seed + 3});
      return add_poster(s, wall, with, {spot.middle_m + 0.5, spot.seed + 4});
    case 5:
      if (to_outside) return add_inside_window(s, wall, with, spot);
      return add_door(s, wall, with, spot);
    case 6:
      add_poster(s, wall, with, left);
      return add_bin(s, wall, with, right);
    case 7:
      add_pillar(s, wall, with, right);
      return add_plant(s, wall, with, left);
    default:
      return;  // bare wall
  }
}

void furnish(Scene& s, const std::array<Wall, 8>& walls, const Fittings& with, std::uint64_t seed) {
  constexpr double kStretch_m = 2.3;
  std::uint32_t kind = static_cast<std::uint32_t>(mix_bits(seed) % 9);
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const bool outer = i % 2 == 0;
    const double from_m = outer ? 2.0 : 0.3, to_m = walls[i].length_m - from_m;
    const int count = static_cast<int>((to_m - from_m) / kStretch_m);
    for (int k = 0; k < count; ++k) {
      NoiseStream draw(seed, NoisePurpose::kPlace, 64 * i + static_cast<std::uint64_t>(k));
      // Kinds come round in turn with jumps, so that each side has some of everything.
      kind = (kind + 1 + static_cast<std::uint32_t>(draw.bits() % 3)) % 9;
      const auto number = static_cast<std::uint32_t>(draw.bits() % 100000U) * 9 + kind;
      const double middle_m = from_m + (k + 0.5) * (to_m - from_m) / count + 0.2 * (draw.uniform() - 0.5);
      furnish_stretch(s, walls[i], with, {middle_m, number}, outer && i % 4 == 0);
    }
  }
}

void add_lamps(Scene& s, const Ring& ring, const Polyline& centre_line) {
  const auto glow = s.add({Pattern::kLamp, {0.97F, 0.97F, 0.93F}, Rgb::Ones(), 1.0F, 0.0F, 0.8F, 0, 0.97F});
  const auto rim = s.add({Pattern::kPaint, {0.6F, 0.6F, 0.6F}, Rgb::Ones(), 1.0F, 0.0F, 0.7F, 0});
  for (const Eigen::Vector3d& p : resample(centre_line, true, 2.5)) {
    const bool along_x = p.y() < 0.01 || p.y() > ring.depth_m - 0.01;
    const Eigen::Vector3d half = along_x ? Eigen::Vector3d(0.6, 0.15, 0) : Eigen::Vector3d(0.15, 0.6, 0);
    const Eigen::Vector3d at(p.x(), p.y(), kHeight_m);
    const Eigen::Vector3d border(0.03, 0.03, 0.0);
    s.add_box(at - half - Eigen::Vector3d(0, 0, 0.045), at + half, glow);
    s.add_box(at - half - border - Eigen::Vector3d(0, 0, 0.03), at + half + border, rim);
    s.light.lamps.push_back({at - Eigen::Vector3d(0, 0, 0.05), half.head<2>(), Rgb(2.7F, 2.65F, 2.45F)});
  }
}

/// Floor, ceiling and walls in one even paint, and nothing on them.
void add_bare_shell(Scene& s, const Ring& ring) {
  constexpr double kOut = kHalfWidth_m + 0.3;
  const auto paint = [&s](const Rgb& colour) {
    return s.add({Pattern::kPaint, colour, colour, 1.0F, 0.0F, 0.2F + 0.7F * colour.mean(), 0});
  };
  const auto floor = paint({0.42F, 0.42F, 0.41F}), wall = paint({0.68F, 0.68F, 0.66F});
  const double x1 = ring.length_m + kOut, y1 = ring.depth_m + kOut;
  s.add_box({-kOut, -kOut, -0.2}, {x1, y1, 0.0}, floor);
  s.add_box({-kOut, -kOut, kHeight_m}, {x1, y1, kHeight_m + 0.2}, paint({0.72F, 0.72F, 0.70F}));
  const std::array<Wall, 8> walls = corridor_walls(ring);
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const double past = i % 2 == 0 ? 0.2 : i % 4 == 3 ? -0.2 : 0.0;
    add_on_wall(s, walls[i], {-past, walls[i].length_m + past, 0.0, kHeight_m, -0.2, 0.0}, wall);
  }
}

void add_furnished_shell(Scene& s, const Ring& ring, std::uint64_t seed) {
  const auto number = static_cast<std::uint32_t>(mix_bits(seed));
  const Fittings with = add_fittings(s, number + 100);
  const std::array<Wall, 8> walls = corridor_walls(ring);
  add_floor_and_ceiling(s, ring, number);
  add_wall_surfaces(s, walls, with, number);
  furnish(s, walls, with, seed);
}

/// Light, route and footways of a corridor whose shell is there.
void finish(Scene& s, const Ring& ring) {
  const Polyline corners{
      {0, 0, 0}, {ring.length_m, 0, 0}, {ring.length_m, ring.depth_m, 0}, {0, ring.depth_m, 0}};
  add_lamps(s, ring, corners);
  s.light.ambient_up = {0.32F, 0.32F, 0.31F};
  s.light.ambient_down = {0.48F, 0.47F, 0.43F};  // the floor throws the lamps' light back up
  s.light.ambient_reach_m = 1.2;
  s.light.texel_m = 0.10;

  Polyline waypoints = resample(smooth_closed(corners, kCornerReach_m), true, 0.2);
  for (Eigen::Vector3d& p : waypoints) p.z() = 0.6;
  s.path = {waypoints, true, 1.3};
  // The robot's route rounds the corners once more; lanes follow where it drives.
  const Polyline driven = smooth_closed(smooth_closed(corners, kCornerReach_m), kRouteReach_m);
  s.footways = {{offset_left(driven, true, -kLaneOffset_m), true, 0.85},
                {offset_left(driven, true, kLaneOffset_m), true, -1.15}};
}

}  // namespace

Scene make_corridor(std::uint64_t seed) {
  constexpr Ring kRing{18.0, 12.0};
  Scene s;
  add_furnished_shell(s, kRing, seed);
  finish(s, kRing);
  return s;
}

Scene make_bare_corridor() {
  constexpr Ring kRing{18.0, 12.0};
  Scene s;
  add_bare_shell(s, kRing);
  finish(s, kRing);
  return s;
}

Scene make_loop(std::uint64_t seed) {
  constexpr Ring kRing{90.0, 60.0};
  Scene s;
  add_furnished_shell(s, kRing, seed);
  finish(s, kRing);
  return s;
}

}  // namespace edgesplat::simulate
