// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/outdoors.hpp"

#include "tools/simulate/world/mover_body.hpp"
#include "tools/simulate/world/texture_noise.hpp"

#include <cmath>

namespace edgesplat::simulate {
namespace {

constexpr double kStorey_m = 3.3;

struct HouseStyle {
  int storeys;
  int axes;  ///< windows beside each other
  bool brick;
  bool balconies;
  Rgb colour;
};

HouseStyle house_style(double length_m, std::uint32_t seed) {
  static constexpr float kColours[7][3] = {
      {0.55F, 0.47F, 0.32F}, {0.60F, 0.57F, 0.50F}, {0.42F, 0.20F, 0.14F}, {0.35F, 0.42F, 0.40F},
      {0.58F, 0.40F, 0.28F}, {0.38F, 0.18F, 0.12F}, {0.62F, 0.61F, 0.58F}};
  const std::uint32_t pick = seed % 7;
  return {3 + static_cast<int>((seed >> 4U) % 3),
          static_cast<int>(length_m / 2.7),
          pick == 2 || pick == 5,
          (seed >> 7U) % 3 != 0,
          {kColours[pick][0], kColours[pick][1], kColours[pick][2]}};
}

void add_window(Scene& s, const Wall& wall, const Fittings& with, double middle_m, double low_m) {
  const double l = middle_m - 0.55, r = middle_m + 0.55, hi = low_m + 1.55;
  add_on_wall(s, wall, {l, r, low_m, hi, 0.0, 0.015}, with.pane);
  add_on_wall(s, wall, {l - 0.09, l, low_m, hi, 0.0, 0.06}, with.frame);
  add_on_wall(s, wall, {r, r + 0.09, low_m, hi, 0.0, 0.06}, with.frame);
  add_on_wall(s, wall, {l - 0.09, r + 0.09, hi, hi + 0.12, 0.0, 0.08}, with.frame);
  add_on_wall(s, wall, {l - 0.14, r + 0.14, low_m - 0.08, low_m, 0.0, 0.14}, with.frame);
  add_on_wall(s, wall, {middle_m - 0.03, middle_m + 0.03, low_m, hi, 0.0, 0.04}, with.frame);
}

void add_balcony(Scene& s, const Wall& wall, const Fittings& with, double middle_m, double floor_m) {
  add_on_wall(s, wall, {middle_m - 1.05, middle_m + 1.05, floor_m - 0.14, floor_m, 0.0, 0.95}, with.frame);
  add_on_wall(s, wall, {middle_m - 1.05, middle_m + 1.05, floor_m + 0.96, floor_m + 1.0, 0.89, 0.95},
              with.dark);
  for (int bar = 0; bar <= 8; ++bar) {
    const double at = middle_m - 1.03 + 0.2575 * bar;
    add_on_wall(s, wall, {at - 0.015, at + 0.015, floor_m, floor_m + 0.96, 0.91, 0.94}, with.dark);
  }
  for (const double side : {-1.04, 1.01})
    add_on_wall(s, wall, {middle_m + side, middle_m + side + 0.03, floor_m + 0.4, floor_m + 1.0, 0.0, 0.9},
                with.dark);
}

/// Shop windows and a door with a name above it.
void add_ground_floor(Scene& s, const Wall& wall, const Fittings& with, std::uint32_t seed) {
  const double door_m = 1.2 + 0.25 * (seed % 5);
  add_door(s, wall, with, {door_m, seed});
  double left = door_m + 1.3;
  for (int i = 0; left + 2.1 < wall.length_m - 0.4; left += 2.6, ++i) {
    add_on_wall(s, wall, {left, left + 2.0, 0.6, 2.5, 0.0, 0.02}, with.pane);
    add_on_wall(s, wall, {left - 0.07, left, 0.5, 2.6, 0.0, 0.09}, with.dark);
    add_on_wall(s, wall, {left + 2.0, left + 2.07, 0.5, 2.6, 0.0, 0.09}, with.dark);
    add_on_wall(s, wall, {left, left + 2.0, 2.5, 2.6, 0.0, 0.09}, with.dark);
    add_on_wall(s, wall, {left, left + 2.0, 0.5, 0.6, 0.0, 0.12}, with.dark);
    const std::uint32_t h = cell_hash(i, 9, seed);
    const Rgb board =
        Rgb(0.1F, 0.1F, 0.12F) + Rgb(0.4F * static_cast<float>(h % 2), 0.25F * static_cast<float>(h / 2 % 2),
                                     0.3F * static_cast<float>(h / 4 % 2));
    const auto sign = s.add({Pattern::kSign, board, {0.85F, 0.83F, 0.76F}, 1.6F, 0.0F, 0.5F, h});
    if (i % 2 == 0) add_on_wall(s, wall, {left + 0.2, left + 1.8, 2.68, 3.1, 0.0, 0.12}, sign);
    const auto poster =
        s.add({Pattern::kPoster, {0.8F, 0.78F, 0.7F}, {0.7F, 0.5F, 0.3F}, 0.6F, 0.02F, 0.7F, h});
    add_on_wall(s, wall, {left + 0.15, left + 0.75, 1.0, 1.84, 0.019, 0.024}, poster);
  }
}

}  // namespace

void add_house(Scene& s, const Wall& wall, const Fittings& with, std::uint32_t seed) {
  const HouseStyle style = house_style(wall.length_m, seed);
  const double height_m = 0.4 + kStorey_m * style.storeys + 0.6;
  const auto front = s.add({style.brick ? Pattern::kBricks : Pattern::kPlaster,
                            style.colour,
                            {0.45F, 0.43F, 0.40F},
                            1.0F,
                            style.brick ? 0.25F : 0.12F,
                            0.25F + 0.5F * style.colour.mean(),
                            seed});
  const auto base =
      s.add({Pattern::kConcrete, {0.36F, 0.35F, 0.33F}, {0.2F, 0.2F, 0.2F}, 1.5F, 0.2F, 0.4F, seed + 1});
  const auto roof =
      s.add({Pattern::kTiles, {0.26F, 0.10F, 0.07F}, {0.10F, 0.05F, 0.04F}, 0.3F, 0.25F, 0.3F, seed + 2});
  add_on_wall(s, wall, {0.0, wall.length_m, 0.0, height_m, -7.0, 0.0}, front);
  add_on_wall(s, wall, {0.0, wall.length_m, 0.0, 0.45, 0.0, 0.012}, base);
  add_on_wall(s, wall, {0.0, wall.length_m, height_m - 0.25, height_m, 0.0, 0.22}, with.frame);  // cornice
  add_on_wall(s, wall, {0.05, wall.length_m - 0.05, height_m, height_m + 1.3, -6.5, -0.4}, roof);
  add_on_wall(s, wall, {0.0, wall.length_m, kStorey_m - 0.02, kStorey_m + 0.1, 0.0, 0.07}, with.frame);
  add_ground_floor(s, wall, with, seed);
  for (int storey = 1; storey < style.storeys; ++storey) {
    for (int axis = 0; axis < style.axes; ++axis) {
      const double middle_m = (axis + 0.5) * wall.length_m / style.axes, floor_m = 0.3 + kStorey_m * storey;
      add_window(s, wall, with, middle_m, floor_m + 0.75);
      if (style.balconies && cell_hash(axis, storey / 2, seed) % 3 == 0)
        add_balcony(s, wall, with, middle_m, floor_m + 0.4);
    }
  }
  const auto pipe = s.add({Pattern::kMetal, {0.33F, 0.34F, 0.33F}, Rgb::Zero(), 1.0F, 0.2F, 0.4F, seed + 3});
  s.add_pillar(wall.at(wall.length_m - 0.12, 0.08, 0.0), 0.05, height_m - 0.25, pipe);
}

void add_tree(Scene& s, const Eigen::Vector3d& foot_m, std::uint32_t seed) {
  const auto bark = s.add({Pattern::kBark, {0.13F, 0.095F, 0.065F}, Rgb::Zero(), 1.0F, 0.35F, 0.3F, seed});
  const float tint = 0.8F + 0.4F * cell_value(1, 1, seed);
  const auto leaves = s.add(
      {Pattern::kFoliage, {0.02F, 0.045F, 0.012F}, Rgb(0.27F, 0.42F, 0.10F) * tint, 1.0F, 0.3F, 0.55F, seed});
  s.add_pillar(foot_m, 0.13, 2.9, bark);
  s.add_pillar(foot_m, 0.19, 0.18, bark);
  constexpr int kTwigs = 34;
  for (int i = 0; i < kTwigs; ++i) {
    const double angle = 2.4 * i, up = 2.5 + 3.2 * i / kTwigs;
    const double reach = 1.5 * std::sqrt(std::max(0.0, 1.0 - std::pow((up - 3.7) / 2.1, 2.0))) *
                         (0.55 + 0.45 * static_cast<double>(cell_value(i, 3, seed)));
    const double size = 0.34 + 0.34 * static_cast<double>(cell_value(i, 2, seed));
    Primitive twig;
    twig.shape = Shape::kEllipsoid;
    twig.material = leaves;
    twig.centre_m = foot_m + Eigen::Vector3d(reach * std::cos(angle), reach * std::sin(angle), up);
    twig.half_m = {1.25 * size, 0.9 * size, 0.65 * size};
    twig.rotate((Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) *
                 Eigen::AngleAxisd(0.5 * std::sin(3.0 * i), Eigen::Vector3d::UnitX()))
                    .toRotationMatrix());
    s.add(twig);
  }
}

void add_street_lamp(Scene& s, const Eigen::Vector3d& foot_m, double arm_y_m, std::uint32_t steel) {
  s.add_pillar(foot_m, 0.06, 5.2, steel);
  s.add_pillar(foot_m, 0.10, 0.8, steel);
  const Eigen::Vector3d top = foot_m + Eigen::Vector3d(0, 0, 5.2), end = top + Eigen::Vector3d(0, arm_y_m, 0);
  s.add_box(top.cwiseMin(end) - Eigen::Vector3d(0.04, 0.0, 0.04),
            top.cwiseMax(end) + Eigen::Vector3d(0.04, 0.0, 0.04), steel);
  s.add_box(end - Eigen::Vector3d(0.15, 0.3, 0.1), end + Eigen::Vector3d(0.15, 0.3, 0.03), steel);
}

void add_parked_car(Scene& s, const Eigen::Vector3d& foot_m, const Eigen::Vector2d& forward,
                    std::uint64_t seed) {
  const MoverBody car = make_car(seed);
  const auto first = static_cast<std::uint32_t>(s.materials.size());
  s.materials.insert(s.materials.end(), car.materials.begin(), car.materials.end());
  for (Primitive part : pose_car(car, {foot_m, forward, 0.0})) {
    part.material += first;
    s.add(part);
  }
}

}  // namespace edgesplat::simulate
