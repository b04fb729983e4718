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

/// What became of a look at the Gaussian map.
enum class GaussianVerdict : std::uint8_t {
  kNotLooked,
  kNoMap,        ///< nothing was drawn, or it fills too little of the picture or shows no texture
  kNoPicture,    ///< of another size than the camera's, or it shows nothing where the map does
  kUnlike,       ///< the map explains too little of the picture
  kContradicts,  ///< alike, but from a pose that the filter holds to be impossible
  kUsed,
};

struct DeskewedPoint {
  Eigen::Vector3f p_in_body_m;  ///< in the body frame at the pose's moment
  float reflectivity;
};

/// The direction of the pose that the LiDAR tells least about. Signal: what the residuals say about it over
/// what the errors of the planes' normals alone would seem to say; near 1 there is nothing in it.
struct WeakestDirection {
  double signal = 0.0;
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();          ///< in the body, with `step_in_odom` of length 1
  Eigen::Vector3d step_in_odom = Eigen::Vector3d::Zero();  ///< per metre
};

/// What the filter found of the sensors' calibration, 1 sigma of it, and what the motion of the last seconds
/// does not show: that stays as it is. What is not estimated has no sigma.
struct SensorOffsets {
  double lidar_delay_s = 0.0;  ///< added to the stamps of rays gives the IMU's time
  double lidar_delay_sigma_s = 0.0;
  bool lidar_delay_frozen = true;
  double camera_delay_s = 0.0;  ///< the same for pictures, beyond the rig's stamp_delay_s
  double camera_delay_sigma_s = 0.0;
  bool camera_delay_frozen = true;
  Eigen::Vector3d lidar_turn_rad = Eigen::Vector3d::Zero();  ///< of the LiDAR against the rig's, in the body
  double lidar_turn_sigma_rad = 0.0;                         ///< of all three
  Eigen::Vector3d lidar_step_m = Eigen::Vector3d::Zero();
  double lidar_step_sigma_m = 0.0;
  int frozen_turns = 3;  ///< of three
  int frozen_steps = 3;
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
  GaussianVerdict gaussian = GaussianVerdict::kNotLooked;  ///< what came of a look at the Gaussian map
  double gaussian_explained = 0.0;    ///< share of the compared pixels that the map foretells
  double gaussian_chi_squared = 0.0;  ///< of its innovation, six degrees of freedom
  SensorOffsets offsets;
};

/// A patch of the visual map in the present picture.
struct TrackedPatch {
  Eigen::Vector2f pixel;  ///< its middle in the camera's picture, at full size
  float side_px = 0.0F;   ///< there
  float misfit = 0.0F;    ///< its mean squared residual over the usual one of the picture
  bool used = false;      ///< it counted, the less the larger its misfit; else it was left out
};

/// One group with its pose: what tracking produces, keyframes and rendering consume. `odom`: continuous,
/// gravity aligned (z up), origin at the first pose.
struct TrackedGroup {
  /// The pose's moment, by the IMU: the group's end, moved by what the camera's stamps were found to be off,
  /// so that the pose is the picture's.
  HostTime stamp{};
  geometry::RigidTransform odom_from_body;
  Eigen::Matrix<double, 6, 6> pose_covariance =
      Eigen::Matrix<double, 6, 6>::Zero();  ///< rotation (rad), translation (m)
  Eigen::Vector3d velocity_in_odom_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d gravity_in_odom_mps2 = Eigen::Vector3d(0.0, 0.0, -9.81);
  TrackingHealth health;
  std::vector<DeskewedPoint> points_in_body;
  std::vector<TrackedPatch>
      patches;  ///< of the picture, at most one a cell of its grid; empty without update
};

}  // namespace edgesplat::tracking
