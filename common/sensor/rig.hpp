// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

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

/// One LiDAR on the body.
struct LidarMount {
  LidarModel model;
  geometry::RigidTransform body_from_lidar;
};

/// More LiDARs a robot cannot have.
inline constexpr std::size_t kMostLidars = 8;

/// Which sensors the robot carries and where. Body = IMU frame; without an IMU body = frame of the first
/// LiDAR. LiDARs are numbered from 0 ("unit"); the IMU is that of the first, unless it is on a line of its
/// own.
struct Rig {
  std::string name = "unnamed";
  LidarModel lidar;                          ///< the first
  geometry::RigidTransform body_from_lidar;  ///< where the first sits
  std::vector<LidarMount> more_lidars;       ///< units 1, 2, ...; fewer than kMostLidars
  std::optional<ImuModel> imu;
  std::optional<CameraMount> camera;

  [[nodiscard]] std::size_t lidar_count() const { return 1 + more_lidars.size(); }
  /// Precondition: unit < lidar_count().
  [[nodiscard]] LidarMount mount_of(std::size_t unit) const {
    return unit == 0 ? LidarMount{lidar, body_from_lidar} : more_lidars.at(unit - 1);
  }
};

}  // namespace edgesplat::sensor
