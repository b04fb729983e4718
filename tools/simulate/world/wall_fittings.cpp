// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/texture_noise.hpp"
#include "tools/simulate/world/wall.hpp"

#include <cmath>

namespace edgesplat::simulate {
namespace {

/// A frame of four bars around an opening, `bar_m` wide and standing `out_m` proud.
void add_frame(Scene& scene, const Wall& wall, const OnWall& inner, double bar_m, std::uint32_t material) {
  const double l = inner.left_m, r = inner.right_m, lo = inner.low_m, hi = inner.high_m;
  const double back = inner.back_m, front = inner.front_m;
  add_on_wall(scene, wall, {l - bar_m, l, lo - bar_m, hi + bar_m, back, front}, material);
  add_on_wall(scene, wall, {r, r + bar_m, lo - bar_m, hi + bar_m, back, front}, material);
  add_on_wall(scene, wall, {l, r, hi, hi + bar_m, back, front}, material);
  if (lo > bar_m) add_on_wall(scene, wall, {l, r, lo - bar_m, lo, back, front}, material);
}

Rgb door_colour(std::uint32_t seed) {
  static constexpr float kColours[5][3] = {{0.42F, 0.26F, 0.13F},
                                           {0.08F, 0.20F, 0.30F},
                                           {0.50F, 0.48F, 0.42F},
                                           {0.34F, 0.08F, 0.06F},
                                           {0.12F, 0.26F, 0.18F}};
  const auto& c = kColours[seed % 5];
  return {c[0], c[1], c[2]};
}

}  // namespace

void add_door(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot) {
  const double m = spot.middle_m, half = spot.seed % 4 == 0 ? 0.85 : 0.47, high = 2.08;
  const Rgb colour = door_colour(spot.seed >> 3U);
  const bool wooden = (spot.seed >> 3U) % 5 == 0;
  const auto leaf = scene.add({wooden ? Pattern::kWood : Pattern::kPlaster, colour, colour * 0.4F, 0.2F,
                               wooden ? 0.3F : 0.06F, 0.25F + 0.5F * colour.mean(), spot.seed});
  add_frame(scene, wall, {m - half, m + half, 0.0, high, 0.0, 0.07}, 0.08, with.frame);
  add_on_wall(scene, wall, {m - half, m + half, 0.0, high, 0.0, 0.015}, leaf);
  add_on_wall(scene, wall, {m - half, m + half, 0.0, 0.22, 0.0, 0.02}, with.steel);  // kick plate
  const double handle = half > 0.6 ? m + 0.06 : m + half - 0.09;
  add_on_wall(scene, wall, {handle - 0.02, handle + 0.02, 0.94, 1.16, 0.0, 0.022}, with.steel);
  add_on_wall(scene, wall, {handle - 0.12, handle + 0.01, 1.04, 1.06, 0.05, 0.075}, with.steel);
  add_on_wall(scene, wall, {handle - 0.01, handle + 0.01, 1.04, 1.06, 0.02, 0.06}, with.steel);
  if (half > 0.6) {
    add_on_wall(scene, wall, {m - 0.006, m + 0.006, 0.0, high, 0.0, 0.018}, with.dark);
    for (const double side : {-0.42, 0.42})
      add_on_wall(scene, wall, {m + side - 0.12, m + side + 0.12, 1.0, 1.8, 0.0, 0.019}, with.pane);
  }
  const auto plate =
      scene.add({Pattern::kSign, {0.70F, 0.71F, 0.72F}, {0.02F, 0.05F, 0.15F}, 0.24F, 0.0F, 0.8F, spot.seed});
  add_on_wall(scene, wall, {m + half + 0.14, m + half + 0.38, 1.5, 1.585, 0.0, 0.012}, plate);
}

void add_inside_window(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot) {
  const double m = spot.middle_m, half = 0.85, low = 0.95, high = 2.3;
  add_frame(scene, wall, {m - half, m + half, low, high, 0.0, 0.06}, 0.07, with.frame);
  add_on_wall(scene, wall, {m - half, m + half, low, high, 0.0, 0.01}, with.view);
  add_on_wall(scene, wall, {m - 0.035, m + 0.035, low, high, 0.0, 0.05}, with.frame);
  add_on_wall(scene, wall, {m - half, m + half, 1.85, 1.91, 0.0, 0.045}, with.frame);
  add_on_wall(scene, wall, {m - half - 0.1, m + half + 0.1, low - 0.11, low - 0.07, 0.0, 0.2},
              with.frame);  // sill
  for (int rib = 0; rib < 11; ++rib) {
    const double left = m - 0.66 + 0.12 * rib;
    add_on_wall(scene, wall, {left, left + 0.085, 0.14, 0.74, 0.04, 0.13}, with.radiator);
  }
  add_on_wall(scene, wall, {m - 0.68, m + 0.68, 0.66, 0.71, 0.06, 0.11}, with.radiator);
}

void add_poster(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot) {
  const double width = 0.5 + 0.1 * (spot.seed % 4), low = 2.0 - 1.4 * width;
  const auto sheet = scene.add({Pattern::kPoster,
                                {0.80F, 0.79F, 0.74F},
                                {0.75F, 0.62F, 0.35F},
                                static_cast<float>(width),
                                0.03F,
                                0.7F,
                                spot.seed});
  const double left = spot.middle_m - width / 2, right = spot.middle_m + width / 2;
  add_on_wall(scene, wall, {left, right, low, low + 1.4 * width, 0.0, 0.006}, sheet);
  if (spot.seed % 3 == 0)
    add_frame(scene, wall, {left, right, low, low + 1.4 * width, 0.0, 0.02}, 0.025, with.dark);
}

void add_board(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot) {
  const double m = spot.middle_m;
  const auto cork =
      scene.add({Pattern::kPaint, {0.42F, 0.27F, 0.13F}, Rgb::Zero(), 1.0F, 0.35F, 0.4F, spot.seed});
  add_on_wall(scene, wall, {m - 0.9, m + 0.9, 0.95, 2.05, 0.0, 0.015}, cork);
  add_frame(scene, wall, {m - 0.9, m + 0.9, 0.95, 2.05, 0.0, 0.03}, 0.03, with.steel);
  for (std::uint32_t i = 0; i < 9; ++i) {
    const std::uint32_t h = cell_hash(static_cast<std::int32_t>(i), 5, spot.seed);
    const double width = 0.21 + 0.03 * (h % 3);
    const double left = m - 0.86 + 0.34 * (i % 5) + 0.005 * (h % 17);
    const double low = (i < 5 ? 1.55 : 1.02) + 0.004 * (h % 25);
    const Rgb paper = h % 4 == 0   ? Rgb(0.85F, 0.75F, 0.30F)
                      : h % 4 == 1 ? Rgb(0.55F, 0.72F, 0.80F)
                                   : Rgb(0.82F, 0.82F, 0.80F);
    const auto sheet =
        scene.add({Pattern::kPoster, paper, paper, static_cast<float>(width), 0.02F, 0.75F, h});
    add_on_wall(scene, wall, {left, left + width, low, low + 1.4 * width, 0.014, 0.0175 + 0.0005 * i}, sheet);
  }
}

void add_pillar(Scene& scene, const Wall& wall, const Fittings& /*with*/, const Spot& spot) {
  const double m = spot.middle_m;
  const auto concrete = scene.add(
      {Pattern::kConcrete, {0.47F, 0.46F, 0.44F}, {0.25F, 0.25F, 0.24F}, 1.2F, 0.16F, 0.45F, spot.seed});
  if (spot.seed % 2 == 0) {
    add_on_wall(scene, wall, {m - 0.2, m + 0.2, 0.0, 2.8, 0.0, 0.26}, concrete);
    add_on_wall(scene, wall, {m - 0.23, m + 0.23, 0.0, 0.12, 0.0, 0.29}, concrete);
  } else {
    scene.add_pillar(wall.at(m, 0.16, 0.0), 0.16, 2.8, concrete);
  }
}

void add_bench(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot) {
  const double m = spot.middle_m;
  for (int slat = 0; slat < 3; ++slat)
    add_on_wall(scene, wall, {m - 0.75, m + 0.75, 0.42, 0.455, 0.06 + 0.125 * slat, 0.165 + 0.125 * slat},
                with.wood);
  add_on_wall(scene, wall, {m - 0.75, m + 0.75, 0.62, 0.78, 0.03, 0.06}, with.wood);
  for (const double side : {-0.6, 0.6}) {
    add_on_wall(scene, wall, {m + side - 0.025, m + side + 0.025, 0.0, 0.42, 0.36, 0.40}, with.steel);
    add_on_wall(scene, wall, {m + side - 0.025, m + side + 0.025, 0.0, 0.78, 0.0, 0.03}, with.steel);
    add_on_wall(scene, wall, {m + side - 0.025, m + side + 0.025, 0.38, 0.42, 0.03, 0.36}, with.steel);
  }
}

void add_bin(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot) {
  scene.add_pillar(wall.at(spot.middle_m, 0.22, 0.0), 0.17, 0.62,
                   spot.seed % 2 == 0 ? with.steel : with.dark);
  scene.add_pillar(wall.at(spot.middle_m, 0.22, 0.62), 0.18, 0.05, with.dark);
}

void add_plant(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot) {
  Primitive pot;
  pot.shape = Shape::kTaperedBox;
  pot.material = with.pot;
  pot.centre_m = wall.at(spot.middle_m, 0.25, 0.21);
  pot.half_m = {0.15, 0.15, 0.21};
  pot.top_scale = {1.3, 1.3};
  scene.add(pot);
  scene.add_box(wall.at(spot.middle_m, 0.25, 0.41) - Eigen::Vector3d(0.17, 0.17, 0),
                wall.at(spot.middle_m, 0.25, 0.43) + Eigen::Vector3d(0.17, 0.17, 0), with.soil);
  scene.add_pillar(wall.at(spot.middle_m, 0.25, 0.42), 0.018, 0.5, with.soil);
  for (int i = 0; i < 9; ++i) {
    const double angle = 2.4 * i + spot.seed % 7, up = 0.62 + 0.075 * i, reach = 0.13 - 0.008 * i;
    const Eigen::Vector3d centre =
        wall.at(spot.middle_m + reach * std::cos(angle), 0.25 + reach * std::sin(angle), up);
    Primitive leaf;
    leaf.shape = Shape::kEllipsoid;
    leaf.material = with.leaf;
    leaf.centre_m = centre;
    leaf.half_m = {0.15, 0.05, 0.085};
    leaf.rotate((Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) *
                 Eigen::AngleAxisd(-0.6, Eigen::Vector3d::UnitY()))
                    .toRotationMatrix());
    scene.add(leaf);
  }
}

void add_extinguisher(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot) {
  const double m = spot.middle_m;
  scene.add_pillar(wall.at(m, 0.10, 0.55), 0.075, 0.45, with.red);
  scene.add_pillar(wall.at(m, 0.10, 1.0), 0.03, 0.09, with.dark);
  add_on_wall(scene, wall, {m - 0.05, m + 0.05, 0.8, 0.84, 0.0, 0.19}, with.dark);
  add_on_wall(scene, wall, {m - 0.11, m + 0.11, 1.65, 1.87, 0.0, 0.006}, with.red);
  add_on_wall(scene, wall, {m - 0.03, m + 0.03, 1.68, 1.84, 0.006, 0.008}, with.frame);
}

}  // namespace edgesplat::simulate
