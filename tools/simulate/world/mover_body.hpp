// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/world/lane_track.hpp"
#include "tools/simulate/world/material.hpp"
#include "tools/simulate/world/primitive.hpp"

#include <cstdint>
#include <vector>

namespace edgesplat::simulate {

/// The parts of one mover in the world, their materials counted within its body.
using Parts = std::vector<Primitive>;

/// What a mover looks like. Immutable; a mover's surface number is 8 * part + face, as for static primitives.
struct MoverBody {
  enum class Kind : std::uint8_t { kPedestrian, kCar };
  Kind kind = Kind::kPedestrian;
  std::vector<Material> materials;
  std::vector<Primitive> rigid_parts;  ///< of a car: x forward, on the ground
  double height_m = 1.75;
  double gait_phase = 0.0;  ///< rad, at time 0
  double reach_m = 1.0;     ///< radius of a ball around the middle that holds all parts in any pose
  double width_m = 0.6;     ///< radius of an upright cylinder that does
};

[[nodiscard]] MoverBody make_pedestrian(std::uint64_t seed);
[[nodiscard]] MoverBody make_car(std::uint64_t seed);
/// Half of a car's footprint, m.
inline constexpr double kCarHalfLength_m = 2.1;
inline constexpr double kCarHalfWidth_m = 0.88;

[[nodiscard]] Parts pose_pedestrian(const MoverBody& body, const Stance& stance);
[[nodiscard]] Parts pose_car(const MoverBody& body, const Stance& stance);

}  // namespace edgesplat::simulate
