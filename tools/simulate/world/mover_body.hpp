// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/check.hpp"
#include "tools/simulate/world/lane_track.hpp"
#include "tools/simulate/world/material.hpp"
#include "tools/simulate/world/primitive.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::simulate {

inline constexpr std::size_t kMaxParts = 24;

/// The parts of one mover in the world, their materials counted within its body.
class PartBuffer {
 public:
  void clear() { count_ = 0; }
  void add(const Primitive& part) {
    EDGESPLAT_CHECK(count_ < kMaxParts, "a mover has more parts than PartBuffer holds");
    parts_[count_++] = part;
  }
  [[nodiscard]] std::span<const Primitive> parts() const { return {parts_.data(), count_}; }

 private:
  std::array<Primitive, kMaxParts> parts_;
  std::size_t count_ = 0;
};

/// What a mover looks like. Immutable; a mover's surface number is 8 * part + face, as for static primitives.
struct MoverBody {
  enum class Kind : std::uint8_t { kPedestrian, kCar };
  Kind kind = Kind::kPedestrian;
  std::vector<Material> materials;
  std::vector<Primitive> rigid_parts;  ///< of a car: x forward, on the ground
  double height_m = 1.75;
  double gait_phase = 0.0;  ///< rad, at time 0
  double reach_m = 1.0;     ///< radius of a ball around the middle that holds all parts in any pose
};

[[nodiscard]] MoverBody make_pedestrian(std::uint64_t seed);
[[nodiscard]] MoverBody make_car(std::uint64_t seed);
/// Half of a car's footprint, m.
inline constexpr double kCarHalfLength_m = 2.1;
inline constexpr double kCarHalfWidth_m = 0.88;

/// Adds the parts of a walking person.
void pose_pedestrian(const MoverBody& body, const Stance& stance, PartBuffer& out);
/// Adds the parts of a car.
void pose_car(const MoverBody& body, const Stance& stance, PartBuffer& out);

}  // namespace edgesplat::simulate
