// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/world/scene.hpp"
#include "tools/simulate/world/wall.hpp"

namespace edgesplat::simulate {

void add_tree(Scene& scene, const Eigen::Vector3d& foot_m, std::uint32_t seed);
void add_street_lamp(Scene& scene, const Eigen::Vector3d& foot_m, double arm_y_m, std::uint32_t steel);
/// A car that stands still; `forward` is a unit vector from above.
void add_parked_car(Scene& scene, const Eigen::Vector3d& foot_m, const Eigen::Vector2d& forward,
                    std::uint64_t seed);
/// A house front of the wall's length with windows, some balconies and a door.
void add_house(Scene& scene, const Wall& wall, const Fittings& with, std::uint32_t seed);

}  // namespace edgesplat::simulate
