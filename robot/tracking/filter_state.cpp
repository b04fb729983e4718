// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/filter_state.hpp"

#include "common/geometry/so3.hpp"

#include <cmath>

namespace edgesplat::tracking {

bool FilterState::is_finite() const {
  return odom_from_body.is_finite() && velocity_in_odom_mps.allFinite() && gyro_bias_radps.allFinite() &&
         accel_bias_mps2.allFinite() && gravity_in_odom_mps2.allFinite() && std::isfinite(log_gain) &&
         std::isfinite(calibration.lidar_delay_s) && std::isfinite(calibration.camera_delay_s) &&
         calibration.body_from_lidar.is_finite();
}

geometry::RigidTransform plus(const geometry::RigidTransform& pose,
                              const Eigen::Matrix<double, 6, 1>& error) {
  return {(pose.rotation * geometry::so3_exp(error.head<3>())).normalized(),
          pose.translation_m + error.tail<3>()};
}

FilterState plus(const FilterState& state, const ErrorVector& error) {
  FilterState sum;
  sum.odom_from_body = plus(state.odom_from_body, Eigen::Matrix<double, 6, 1>(error.head<6>()));
  sum.velocity_in_odom_mps = state.velocity_in_odom_mps + error.segment<3>(kVel);
  sum.gyro_bias_radps = state.gyro_bias_radps + error.segment<3>(kGyroBias);
  sum.accel_bias_mps2 = state.accel_bias_mps2 + error.segment<3>(kAccelBias);
  sum.gravity_in_odom_mps2 = state.gravity_in_odom_mps2 + error.segment<3>(kGravity);
  sum.log_gain = state.log_gain + error(kGain);
  sum.calibration = state.calibration;
  return sum;
}

ErrorVector minus(const FilterState& state, const FilterState& other) {
  ErrorVector error;
  error.segment<3>(kRot) =
      geometry::so3_log(other.odom_from_body.rotation.conjugate() * state.odom_from_body.rotation);
  error.segment<3>(kPos) = state.odom_from_body.translation_m - other.odom_from_body.translation_m;
  error.segment<3>(kVel) = state.velocity_in_odom_mps - other.velocity_in_odom_mps;
  error.segment<3>(kGyroBias) = state.gyro_bias_radps - other.gyro_bias_radps;
  error.segment<3>(kAccelBias) = state.accel_bias_mps2 - other.accel_bias_mps2;
  error.segment<3>(kGravity) = state.gravity_in_odom_mps2 - other.gravity_in_odom_mps2;
  error(kGain) = state.log_gain - other.log_gain;
  return error;
}

SensorCalibration plus(const SensorCalibration& calibration, const CalibrationVector& error) {
  SensorCalibration sum = calibration;
  sum.lidar_delay_s += error(kLidarDelay);
  sum.camera_delay_s += error(kCameraDelay);
  geometry::RigidTransform& mounting = sum.body_from_lidar;
  // What is held keeps its bits.
  if (!error.segment<3>(kLidarTurn).isZero(0.0))
    mounting.rotation = (geometry::so3_exp(error.segment<3>(kLidarTurn)) * mounting.rotation).normalized();
  mounting.translation_m += error.segment<3>(kLidarStep);
  return sum;
}

CalibrationVector minus(const SensorCalibration& calibration, const SensorCalibration& other) {
  CalibrationVector error;
  error(kLidarDelay) = calibration.lidar_delay_s - other.lidar_delay_s;
  error(kCameraDelay) = calibration.camera_delay_s - other.camera_delay_s;
  error.segment<3>(kLidarTurn) =
      geometry::so3_log(calibration.body_from_lidar.rotation * other.body_from_lidar.rotation.conjugate());
  error.segment<3>(kLidarStep) =
      calibration.body_from_lidar.translation_m - other.body_from_lidar.translation_m;
  return error;
}

}  // namespace edgesplat::tracking
