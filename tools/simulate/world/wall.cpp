// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/wall.hpp"

namespace edgesplat::simulate {

Wall make_wall(const Eigen::Vector2d& left_end_m, const Eigen::Vector2d& right_end_m) {
  Wall wall;
  wall.left_end_m = left_end_m;
  wall.length_m = (right_end_m - left_end_m).norm();
  wall.right = (right_end_m - left_end_m) / wall.length_m;
  wall.front = {wall.right.y(), -wall.right.x()};
  return wall;
}

void add_on_wall(Scene& scene, const Wall& wall, const OnWall& box, std::uint32_t material) {
  const Eigen::Vector3d a = wall.at(box.left_m, box.back_m, box.low_m);
  const Eigen::Vector3d b = wall.at(box.right_m, box.front_m, box.high_m);
  scene.add_box(a.cwiseMin(b), a.cwiseMax(b), material);
}

Fittings add_fittings(Scene& scene, std::uint32_t seed) {
  const auto paint = [&](const Rgb& colour, float contrast, float reflectivity) {
    return scene.add({Pattern::kPaint, colour, colour, 1.0F, contrast, reflectivity, ++seed});
  };
  Fittings f{};
  f.frame = paint({0.62F, 0.62F, 0.60F}, 0.05F, 0.7F);
  f.door =
      scene.add({Pattern::kWood, {0.42F, 0.26F, 0.13F}, {0.15F, 0.09F, 0.05F}, 0.23F, 0.30F, 0.45F, ++seed});
  f.steel =
      scene.add({Pattern::kMetal, {0.48F, 0.49F, 0.50F}, {0.3F, 0.3F, 0.3F}, 1.0F, 0.15F, 0.6F, ++seed});
  f.dark = paint({0.06F, 0.065F, 0.07F}, 0.25F, 0.10F);
  f.view = scene.add({Pattern::kWindowView, {0.05F, 0.05F, 0.05F}, Rgb::Zero(), 1.0F, 0.0F, 0.06F, ++seed});
  f.pane = scene.add({Pattern::kPane, {0.03F, 0.035F, 0.04F}, Rgb::Zero(), 1.0F, 0.0F, 0.06F, ++seed});
  f.wood =
      scene.add({Pattern::kWood, {0.50F, 0.33F, 0.17F}, {0.2F, 0.12F, 0.06F}, 0.12F, 0.28F, 0.5F, ++seed});
  f.soil = paint({0.07F, 0.045F, 0.03F}, 0.5F, 0.15F);
  f.leaf = scene.add(
      {Pattern::kFoliage, {0.015F, 0.05F, 0.012F}, {0.16F, 0.34F, 0.07F}, 1.0F, 0.3F, 0.55F, ++seed});
  f.pot =
      scene.add({Pattern::kConcrete, {0.45F, 0.23F, 0.14F}, {0.3F, 0.15F, 0.1F}, 3.0F, 0.15F, 0.4F, ++seed});
  f.radiator = paint({0.72F, 0.72F, 0.69F}, 0.04F, 0.75F);
  f.red = paint({0.50F, 0.025F, 0.02F}, 0.1F, 0.55F);
  return f;
}

}  // namespace edgesplat::simulate
