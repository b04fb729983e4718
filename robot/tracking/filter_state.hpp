// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/rigid_transform.hpp"

#include <Eigen/Core>

namespace edgesplat::tracking {

/// Places of the error state's parts; rotation and position first, so that LiDAR residuals touch a 6x6
/// corner, then the gain, so that photometric ones touch a 7x7 corner.
enum ErrorIndex : int {
  kRot = 0,
  kPos = 3,
  kGain = 6,
  kVel = 7,
  kGyroBias = 10,
  kAccelBias = 13,
  kGravity = 16
};
constexpr int kErrorSize = 19;
using ErrorVector = Eigen::Matrix<double, kErrorSize, 1>;
using ErrorMatrix = Eigen::Matrix<double, kErrorSize, kErrorSize>;

/// Of the Earth, wherever the body is, and 1 sigma of it: latitude and height change it by 0.3 %.
inline constexpr double kGravity_mps2 = 9.81;
inline constexpr double kGravityNormSigma_mps2 = 0.02;

/// What the filter estimates. The rotation's error acts on the right, the others add (rigid_transform.hpp).
struct FilterState {
  geometry::RigidTransform odom_from_body;
  Eigen::Vector3d velocity_in_odom_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d gravity_in_odom_mps2 = Eigen::Vector3d(0.0, 0.0, -kGravity_mps2);
  /// Natural logarithm of how bright the camera shows things, the first picture being 0: the gain itself is
  /// positive by construction.
  double log_gain = 0.0;

  [[nodiscard]] bool is_finite() const;
};

/// state ⊞ error.
[[nodiscard]] FilterState plus(const FilterState& state, const ErrorVector& error);
/// The error with other ⊞ error == state.
[[nodiscard]] ErrorVector minus(const FilterState& state, const FilterState& other);

/// A state with the covariance of its error.
struct FilterBelief {
  FilterState state;
  ErrorMatrix covariance = ErrorMatrix::Identity();
};

}  // namespace edgesplat::tracking
