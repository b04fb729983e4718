// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/world/scene.hpp"

namespace edgesplat::simulate {

/// Where a mover stands on the ground.
struct Stance {
  Eigen::Vector3d foot_m = Eigen::Vector3d::Zero();
  Eigen::Vector2d forward = Eigen::Vector2d::UnitX();  ///< unit, from above
  double travelled_m = 0.0;                            ///< since time 0, for the gait
};

/// A lane by distance: position in constant time. Immutable, thread-safe.
class LaneTrack {
 public:
  explicit LaneTrack(const Lane& lane);
  /// The mover that is `start_m` along the lane at time 0.
  [[nodiscard]] Stance at(double start_m, double time_s) const;
  /// at().foot_m alone, several times faster.
  [[nodiscard]] Eigen::Vector3d foot_m(double start_m, double time_s) const;
  [[nodiscard]] double length_m() const { return length_m_; }

 private:
  struct Place {
    std::size_t index;
    double fraction;
  };
  [[nodiscard]] Place place(double start_m, double time_s) const;
  std::vector<Eigen::Vector3d> points_m_;  ///< one every spacing_m_; a closed lane ends with its first point
  double spacing_m_ = 0.1;
  double length_m_ = 0.0;
  double speed_mps_ = 1.0;
};

}  // namespace edgesplat::simulate
