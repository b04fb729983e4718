// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/world/scene.hpp"

namespace edgesplat::simulate {

/// An upright aligned wall seen from the front: things are placed on it by `along` (m to the right of its
/// left end), `out` (m in front of it) and height.
struct Wall {
  Eigen::Vector2d left_end_m;
  Eigen::Vector2d right;  ///< unit, along x or y
  Eigen::Vector2d front;  ///< unit, `right` turned right by 90 degrees
  double length_m = 0.0;
  double foot_m = 0.0;  ///< height of the ground

  [[nodiscard]] Eigen::Vector3d at(double along_m, double out_m, double up_m) const {
    const Eigen::Vector2d p = left_end_m + along_m * right + out_m * front;
    return {p.x(), p.y(), foot_m + up_m};
  }
};
/// From the left end to the right end as somebody in front of it sees them.
[[nodiscard]] Wall make_wall(const Eigen::Vector2d& left_end_m, const Eigen::Vector2d& right_end_m);

/// Extent of a box on a wall.
struct OnWall {
  double left_m, right_m;  ///< along
  double low_m, high_m;    ///< height
  double back_m, front_m;  ///< out
};
void add_on_wall(Scene& scene, const Wall& wall, const OnWall& box, std::uint32_t material);

/// Materials that fittings share.
struct Fittings {
  std::uint32_t frame, door, steel, dark, view, pane, wood, soil, leaf, pot, radiator, red;
};
[[nodiscard]] Fittings add_fittings(Scene& scene, std::uint32_t seed);

/// Fittings by the middle of their place along the wall.
struct Spot {
  double middle_m;
  std::uint32_t seed;
};
void add_door(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot);
void add_inside_window(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot);
void add_poster(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot);
void add_board(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot);
void add_pillar(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot);
void add_bench(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot);
void add_bin(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot);
void add_plant(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot);
void add_extinguisher(Scene& scene, const Wall& wall, const Fittings& with, const Spot& spot);

}  // namespace edgesplat::simulate
