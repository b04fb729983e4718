// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/scan_update.hpp"

#include <Eigen/Core>

#include <array>

namespace edgesplat::tracking {

/// The sums of PlaneResiduals over one block of a scan: few enough points for 32 bits, and of what is
/// symmetric the upper triangle.
class PlaneSums {
 public:
  /// A point's residual with its weight (1 / m^2); `p_in_body_m` and the rotation of its row's pose.
  void add(const MatchedPoint& line, const Eigen::Vector3f& p_in_body_m,
           const Eigen::Matrix3f& odom_from_body_rotation, float weight);
  [[nodiscard]] PlaneResiduals total(int matched) const;

 private:
  /// Of a 6x6 matrix, row by row.
  using Triangle = std::array<float, 21>;
  static Matrix6d widened(const Triangle& upper);
  void add_noise(const Plane& plane, const Eigen::Vector3f& p, const Eigen::Matrix3f& rotation, float weight);

  Triangle information_{};
  Triangle noise_{};
  Eigen::Matrix<float, 6, 1> gradient_ = Eigen::Matrix<float, 6, 1>::Zero();
  int used_ = 0;
  double squares_m2_ = 0.0;
};

}  // namespace edgesplat::tracking
