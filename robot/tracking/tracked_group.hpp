// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/rigid_transform.hpp"
#include "common/time/time.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace edgesplat::tracking {

enum class TrackingState : std::uint8_t {
  kInitialising,  ///< gathering IMU samples for gravity; the pose is not valid yet
  kTracking,      ///< LiDAR and camera together see every direction
  kDegraded,      ///< a direction is the IMU's alone, or the LiDAR is out and the picture carries the pose
  kCoasting,      ///< neither scan nor picture fitted: pose from the IMU or constant velocity alone
  kLost,          ///< coasted for too long: the pose is a guess, and is looked for in the map
  kRecovered,     ///< found again less than a second ago
};

struct DeskewedPoint {
  Eigen::Vector3f p_in_body_m;  ///< in the body frame at the group's end
  float reflectivity;
};

/// The direction of the pose that the LiDAR tells least about. Signal: what the residuals say about it over
/// what the errors of the planes' normals alone would seem to say; near 1 there is nothing in it.
struct WeakestDirection {
  double signal = 0.0;
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();          ///< in the body, with `step_in_odom` of length 1
  Eigen::Vector3d step_in_odom = Eigen::Vector3d::Zero();  ///< per metre
};

/// How far the pose can be trusted.
struct TrackingHealth {
  TrackingState state = TrackingState::kInitialising;
  int points_used = 0;  ///< residuals in the last iteration
  int iterations = 0;
  double residual_rms_m = 0.0;
  /// Smallest eigenvalue of the translation information over the largest: under 1e-3 a direction is
  /// unobserved.
  double translation_conditioning = 0.0;
  int frozen_directions = 0;  ///< of six: the LiDAR was not believed about these
  WeakestDirection weakest;
  int visual_patches = 0;           ///< patches that the picture was aligned with; 0: it was not
  double visual_noise_scale = 0.0;  ///< how much larger their residuals are than the noise explains
  double log_gain = 0.0;            ///< of the picture's brightness, the first picture being 0
};

/// One group with its pose: what tracking produces, keyframes and rendering consume. `odom`: continuous,
/// gravity aligned (z up), origin at the first pose.
struct TrackedGroup {
  HostTime stamp{};  ///< the group's end
  geometry::RigidTransform odom_from_body;
  Eigen::Matrix<double, 6, 6> pose_covariance =
      Eigen::Matrix<double, 6, 6>::Zero();  ///< rotation (rad), translation (m)
  Eigen::Vector3d velocity_in_odom_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d gravity_in_odom_mps2 = Eigen::Vector3d(0.0, 0.0, -9.81);
  TrackingHealth health;
  std::vector<DeskewedPoint> points_in_body;
};

}  // namespace edgesplat::tracking
