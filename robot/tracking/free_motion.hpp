// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/filter_state.hpp"
#include "robot/tracking/propagation.hpp"
#include "robot/tracking/tracking_config.hpp"

namespace edgesplat::tracking {

/// How restless a body without IMU is: the configured least, raised to what the last updates showed.
/// Single-owner.
class FreeMotion {
 public:
  explicit FreeMotion(const TrackingConfig& config) : config_(config) {}

  /// Noise of constant velocity where the gyro bias stands for the rotation rate (predict_without_imu).
  [[nodiscard]] MotionNoise without_imu() const;
  /// Noise of a hole in the IMU's data, where rotation itself is uncertain.
  [[nodiscard]] MotionNoise in_a_hole() const;
  /// Learns from what an update changed after a prediction over `dt_s`.
  void observe(const ErrorVector& correction, double dt_s);
  /// The belief of a body about which nothing is known but where it is: at the origin of odom.
  [[nodiscard]] FilterBelief first_belief() const;

 private:
  TrackingConfig config_;
  double accel_density_squared_ = 0.0;  ///< running mean of what was seen
  double turn_density_squared_ = 0.0;
};

}  // namespace edgesplat::tracking
