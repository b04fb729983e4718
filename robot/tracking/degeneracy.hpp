// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/tracked_group.hpp"

#include <Eigen/Core>

namespace edgesplat::tracking {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Turns move what is this far away: to compare turns with steps.
inline constexpr double kLever_m = 5.0;

/// Normal equations on (rotation, position), and the part of them that noise would make by itself.
struct NormalEquations {
  Matrix6d information = Matrix6d::Zero();  ///< sum of w h h'
  Vector6d gradient = Vector6d::Zero();     ///< sum of w h r
  Matrix6d noise = Matrix6d::Zero();        ///< sum of w Cov(h), h being made of a noisy normal
};

struct ObservedPart {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  int frozen = 0;  ///< directions left out
  /// Projectors on the span of those that are mainly steps, in odom, and mainly turns, in the body.
  Eigen::Matrix3d frozen_steps = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d frozen_turns = Eigen::Matrix3d::Zero();
  WeakestDirection weakest;
};

/// What normal equations say apart from noise. A wall's estimated normal tilts by chance; rows made of it
/// seem to see along the wall, and many of them add up to a false certainty (errors in variables). In
/// expectation the information is too large by just `noise`, which is known. In the basis of the generalised
/// eigenvectors of the two, whatever the units of rotation and position, direction k has the signal
/// l_k = information / noise: it keeps the share (l_k - 1) / l_k where l_k is well above 1, nothing where it
/// is near 1, and a part in between. The direction's own estimate stays, only its weight changes.
[[nodiscard]] ObservedPart keep_observed(const NormalEquations& equations);

}  // namespace edgesplat::tracking
