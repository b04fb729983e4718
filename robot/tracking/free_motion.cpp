// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/free_motion.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::tracking {
namespace {

/// Weight of the newest update: the unrest of the last second or so at 10 Hz.
constexpr double kForget = 0.15;
/// Never more than this over the configured least: one bad update must not open the filter to anything.
constexpr double kMaxRaise = 10.0;

double raised(double least, double seen_squared) {
  return std::clamp(std::sqrt(seen_squared), least, kMaxRaise * least);
}

}  // namespace

MotionNoise FreeMotion::without_imu() const {
  MotionNoise noise;
  noise.velocity_mps2_per_sqrt_hz = raised(config_.motion_accel_mps2_per_sqrt_hz, accel_density_squared_);
  noise.gyro_bias_radps2_per_sqrt_hz = raised(config_.motion_turn_radps2_per_sqrt_hz, turn_density_squared_);
  return noise;
}

MotionNoise FreeMotion::in_a_hole() const {
  MotionNoise noise;
  noise.velocity_mps2_per_sqrt_hz = config_.motion_accel_mps2_per_sqrt_hz;
  noise.rotation_radps_per_sqrt_hz = config_.motion_turn_radps2_per_sqrt_hz;
  return noise;
}

void FreeMotion::observe(const ErrorVector& correction, double dt_s) {
  if (!(dt_s > 1e-3)) return;
  const double accel = correction.segment<3>(kVel).squaredNorm() / (3.0 * dt_s);
  const double turn = correction.segment<3>(kGyroBias).squaredNorm() / (3.0 * dt_s);
  accel_density_squared_ += kForget * (accel - accel_density_squared_);
  turn_density_squared_ += kForget * (turn - turn_density_squared_);
}

FilterBelief FreeMotion::first_belief() const {
  FilterBelief belief;
  belief.state.gravity_in_odom_mps2.setZero();  // no IMU feels it: the equations of motion without weight
  belief.covariance.setZero();
  const auto set = [&](int index, double sigma) {
    belief.covariance.diagonal().segment<3>(index).setConstant(sigma * sigma);
  };
  set(kRot, 1e-4);
  set(kPos, 1e-4);
  set(kVel, config_.init_moving_speed_sigma_mps);
  set(kGyroBias, 0.5);
  return belief;
}

}  // namespace edgesplat::tracking
