// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace edgesplat::simulate {

/// x, y, z (m), yaw, pitch, roll (rad).
using BodyCoordinates = Eigen::Matrix<double, 6, 1>;

/// A uniform quintic B-spline over time: four continuous derivatives, all of them exact. Control point j acts
/// around time (j - 2) * knot_s. Immutable, thread-safe; O(1) an evaluation.
class BodySpline {
 public:
  static constexpr std::size_t kOrder = 6;
  /// How many control points cover [0, duration_s].
  static std::size_t control_points_for(double duration_s, double knot_s);
  /// Time around which control point j acts.
  static double control_time_s(std::size_t j, double knot_s) {
    return (static_cast<double>(j) - 2.0) * knot_s;
  }

  /// At least kOrder control points.
  BodySpline(std::vector<BodyCoordinates> control_points, double knot_s);

  /// The curve's derivative of order 0..3 at time_s, which is held inside [0, duration_s()].
  [[nodiscard]] BodyCoordinates derivative(double time_s, int order) const;
  [[nodiscard]] double duration_s() const;

 private:
  std::vector<BodyCoordinates> control_points_;
  double knot_s_;
};

}  // namespace edgesplat::simulate
