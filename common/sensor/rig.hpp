// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"

#include <optional>
#include <string>

namespace edgesplat::sensor {

/// Noise of one LiDAR as its data sheet states it.
struct LidarModel {
  std::string name = "mid360";
  double range_sigma_m = 0.02;        ///< 1 sigma along the ray
  double bearing_sigma_rad = 0.0026;  ///< 1 sigma across the ray (0.15 degrees)
  double min_range_m = 0.3;           ///< nearer returns are dropped (the robot itself)
  double max_range_m = 70.0;
};

/// Continuous-time noise of one IMU (Kalibr's conventions).
struct ImuModel {
  double gyro_noise_radps_per_sqrt_hz = 2e-3;
  double accel_noise_mps2_per_sqrt_hz = 2e-2;
  double gyro_bias_walk_radps2_per_sqrt_hz = 2e-5;
  double accel_bias_walk_mps3_per_sqrt_hz = 2e-4;
  double rate_hz = 200.0;
};

struct CameraMount {
  geometry::CameraModel model;
  geometry::RigidTransform body_from_camera;
  double stamp_delay_s = 0.0;  ///< added to the frame's stamp to get the middle of the exposure
};

/// Which sensors the robot carries and where. Body = IMU frame; without an IMU body = LiDAR frame.
struct Rig {
  std::string name = "unnamed";
  LidarModel lidar;
  geometry::RigidTransform body_from_lidar;
  std::optional<ImuModel> imu;
  std::optional<CameraMount> camera;
};

}  // namespace edgesplat::sensor
