// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/filter_state.hpp"

#include "common/geometry/so3.hpp"

#include <cmath>

namespace edgesplat::tracking {

bool FilterState::is_finite() const {
  return odom_from_body.is_finite() && velocity_in_odom_mps.allFinite() && gyro_bias_radps.allFinite() &&
         accel_bias_mps2.allFinite() && gravity_in_odom_mps2.allFinite() && std::isfinite(log_gain);
}

FilterState plus(const FilterState& state, const ErrorVector& error) {
  FilterState sum;
  sum.odom_from_body.rotation =
      (state.odom_from_body.rotation * geometry::so3_exp(error.segment<3>(kRot))).normalized();
  sum.odom_from_body.translation_m = state.odom_from_body.translation_m + error.segment<3>(kPos);
  sum.velocity_in_odom_mps = state.velocity_in_odom_mps + error.segment<3>(kVel);
  sum.gyro_bias_radps = state.gyro_bias_radps + error.segment<3>(kGyroBias);
  sum.accel_bias_mps2 = state.accel_bias_mps2 + error.segment<3>(kAccelBias);
  sum.gravity_in_odom_mps2 = state.gravity_in_odom_mps2 + error.segment<3>(kGravity);
  sum.log_gain = state.log_gain + error(kGain);
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

}  // namespace edgesplat::tracking
