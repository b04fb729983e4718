// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

namespace edgesplat::config {
class ConfigReader;
}

namespace edgesplat::tracking {

/// Everything tracking can be told; the defaults suit a Mid-360 at walking pace, in- and outdoors. The noise
/// of the sensors is not here: it is in sensor::Rig.
struct TrackingConfig {
  int threads = 1;  ///< threads of the parallel loops; the result does not depend on it, [1, 64]

  double init_s = 0.3;  ///< rest that gives gravity and the gyro's bias before the first pose, [0.05, 10]
  double init_accel_spread_max_mps2 =
      0.4;  ///< more spread, the IMU's noise apart: the start counts as moving, (0, 10]
  double init_gyro_rate_max_radps =
      0.05;                       ///< a mean rate or spread above: the start counts as moving, (0, 1]
  double init_rest_wait_s = 0.0;  ///< for rest, before a start in motion is taken, [0, 600]
  double init_moving_s = 1.0;     ///< of scans and IMU that a start in motion is found from, [0.3, 10]
  double init_moving_speed_sigma_mps = 2.0;  ///< 1 sigma of the unknown first speed, (0, 50]

  double motion_accel_mps2_per_sqrt_hz =
      1.0;  ///< least unrest of the motion without IMU, adapted up, (0, 100]
  double motion_turn_radps2_per_sqrt_hz = 0.5;  ///< the same for rotation, (0, 100]

  double scan_voxel_m = 0.2;   ///< thinning of the points that are matched, [0.01, 5]
  double map_voxel_m = 0.2;    ///< thinning of those that enter the map: done once where equal, [0.01, 5]
  int max_scan_points = 3000;  ///< more matched points than this are thinned evenly, [100, 100000]

  double root_voxel_m = 1.0;         ///< edge of the map's coarsest cells, [0.1, 10]
  int max_layer = 2;                 ///< how often a cell that is no plane is split in eight, [0, 4]
  double plane_sigma_max_m = 0.05;   ///< a cell whose points scatter more across is no plane, [0.001, 1]
  int plane_min_points = 6;          ///< points before a plane is fitted, [5, 16]
  int plane_freeze_points = 3000;    ///< a plane takes no more points after these, [8, 100000]
  double map_half_extent_m = 100.0;  ///< cells farther than this along an axis are forgotten, [5, 10000]
  int map_max_mb = 256;              ///< the farthest cells are forgotten above this size, [8, 65536]

  int max_iterations = 6;              ///< of one update, [1, 50]
  double gate_sigma = 3.0;             ///< residuals beyond this many sigma are left out, [1, 10]
  double min_residual_sigma_m = 0.01;  ///< model error of every residual: curvature, roughness, [0.0001, 1]
  int min_residuals = 30;              ///< with fewer the group coasts, [6, 10000]
  double max_range_m = 120.0;          ///< farther points are left out of matching and map, [1, 1000]

  double lidar_delay_s = 0.0;         ///< added to the stamps of rays gives the IMU's time, [-0.1, 0.1]
  double camera_delay_s = 0.0;        ///< the same for pictures, beyond the rig's stamp_delay_s, [-0.1, 0.1]
  double lidar_delay_sigma_s = 0.0;   ///< 1 sigma of it before the start; 0: held, [0, 0.05]
  double camera_delay_sigma_s = 0.0;  ///< the same, [0, 0.05]
  double lidar_turn_sigma_rad = 0.0;  ///< of the rig's body_from_lidar, each axis; 0: held, [0, 0.1]
  double lidar_step_sigma_m = 0.0;    ///< the same, [0, 0.2]
  [[nodiscard]] bool estimates_calibration() const {
    return lidar_delay_sigma_s > 0.0 || camera_delay_sigma_s > 0.0 || lidar_turn_sigma_rad > 0.0 ||
           lidar_step_sigma_m > 0.0;
  }

  bool visual = true;  ///< pictures update the pose after the LiDAR, where the rig has a camera
  bool visual_refine_normals = false;  ///< visual points take their normals anew from the planes
  int visual_map_max_mb = 32;  ///< the farthest visual points are forgotten above this size, [1, 4096]

  int gaussian_every =
      0;  ///< every so many pictures are held against the Gaussian map too, 0 = none, [0, 1000]
  int gaussian_width_px = 320;  ///< for that it is drawn at the first halving at most so wide, [80, 1280]
  bool gaussian_depth = false;  ///< and the scan's points are held against its depth
};

/// Visits every field with its range, for common/config.
void describe(config::ConfigReader& reader, TrackingConfig& config);
/// kInvalidConfig with the field, its value and its range where one is out of range.
[[nodiscard]] Status validate(const TrackingConfig& config);

}  // namespace edgesplat::tracking
