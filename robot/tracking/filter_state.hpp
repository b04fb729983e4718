// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/rigid_transform.hpp"

#include <Eigen/Core>

#include <optional>

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

/// Places of the calibration's errors. They follow the state's where a part of the calibration is estimated.
enum CalibrationIndex : int { kLidarDelay = 0, kCameraDelay = 1, kLidarTurn = 2, kLidarStep = 5 };
constexpr int kCalibrationErrors = 8;
constexpr int kFullSize = kErrorSize + kCalibrationErrors;
using CalibrationVector = Eigen::Matrix<double, kCalibrationErrors, 1>;
using CalibrationMatrix = Eigen::Matrix<double, kCalibrationErrors, kCalibrationErrors>;

/// Of the Earth, wherever the body is, and 1 sigma of it: latitude and height change it by 0.3 %.
inline constexpr double kGravity_mps2 = 9.81;
inline constexpr double kGravityNormSigma_mps2 = 0.02;

/// How the sensors hang together in time and space, the IMU being what all is told by. With several LiDARs
/// it is that of all of them together: one delay, and one mounting that they are moved along with.
struct SensorCalibration {
  double lidar_delay_s = 0.0;                ///< added to the stamps of rays gives the IMU's time
  double camera_delay_s = 0.0;               ///< the same for pictures, beyond the rig's stamp_delay_s
  geometry::RigidTransform body_from_lidar;  ///< the first one's
};

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
  SensorCalibration calibration;

  [[nodiscard]] bool is_finite() const;
};

/// state ⊞ error.
[[nodiscard]] FilterState plus(const FilterState& state, const ErrorVector& error);
/// pose ⊞ (rotation, translation): the convention of rigid_transform.hpp.
[[nodiscard]] geometry::RigidTransform plus(const geometry::RigidTransform& pose,
                                            const Eigen::Matrix<double, 6, 1>& error);
/// The error with other ⊞ error == state.
[[nodiscard]] ErrorVector minus(const FilterState& state, const FilterState& other);

/// The mounting errs by a turn and a step in the body's axes: turned on the left, moved by the sum.
[[nodiscard]] SensorCalibration plus(const SensorCalibration& calibration, const CalibrationVector& error);
[[nodiscard]] CalibrationVector minus(const SensorCalibration& calibration, const SensorCalibration& other);

/// Covariance of the calibration's error, and with the state's.
struct CalibrationDoubt {
  CalibrationMatrix covariance = CalibrationMatrix::Zero();
  Eigen::Matrix<double, kErrorSize, kCalibrationErrors> with_state =
      Eigen::Matrix<double, kErrorSize, kCalibrationErrors>::Zero();
};

/// A state with the covariance of its error.
struct FilterBelief {
  FilterState state;
  ErrorMatrix covariance = ErrorMatrix::Identity();
  std::optional<CalibrationDoubt> calibration = std::nullopt;  ///< none: it is held, and costs nothing
};

}  // namespace edgesplat::tracking
