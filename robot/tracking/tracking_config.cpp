// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/tracking_config.hpp"

#include "common/config/config_file.hpp"

namespace edgesplat::tracking {

void describe(config::ConfigReader& reader, TrackingConfig& config) {
  reader.field("threads", config.threads, {1, 64},
               "threads of the parallel loops; the result does not depend on it");
  reader.field("init_s", config.init_s, {0.05, 10},
               "rest that gives gravity and the gyro's bias before the first pose");
  reader.field("init_accel_spread_max_mps2", config.init_accel_spread_max_mps2, {1e-6, 10},
               "more spread than this: the start counts as moving");
  reader.field("init_gyro_rate_max_radps", config.init_gyro_rate_max_radps, {1e-6, 1},
               "a mean rate or spread above: the start counts as moving");
  reader.field("init_moving_speed_sigma_mps", config.init_moving_speed_sigma_mps, {1e-3, 50},
               "1 sigma of the unknown first speed");
  reader.field("init_rest_wait_s", config.init_rest_wait_s, {0, 600},
               "for rest, before a start in motion is taken");
  reader.field("init_moving_s", config.init_moving_s, {0.3, 10},
               "of scans and IMU that a start in motion is found from");
  reader.field("motion_accel_mps2_per_sqrt_hz", config.motion_accel_mps2_per_sqrt_hz, {1e-6, 100},
               "least unrest of the motion without IMU, adapted up");
  reader.field("motion_turn_radps2_per_sqrt_hz", config.motion_turn_radps2_per_sqrt_hz, {1e-6, 100},
               "the same for rotation");
  reader.field("scan_voxel_m", config.scan_voxel_m, {0.01, 5}, "thinning of the points that are matched");
  reader.field("map_voxel_m", config.map_voxel_m, {0.01, 5}, "thinning of the points that enter the map");
  reader.field("max_scan_points", config.max_scan_points, {100, 100000},
               "more matched points than this are thinned evenly");
  reader.field("root_voxel_m", config.root_voxel_m, {0.1, 10}, "edge of the map's coarsest cells");
  reader.field("max_layer", config.max_layer, {0, 4}, "how often a cell that is no plane is split in eight");
  reader.field("plane_sigma_max_m", config.plane_sigma_max_m, {0.001, 1},
               "a cell whose points scatter more across is no plane");
  reader.field("plane_min_points", config.plane_min_points, {5, 16}, "points before a plane is fitted");
  reader.field("plane_freeze_points", config.plane_freeze_points, {8, 100000},
               "a plane takes no more points after these");
  reader.field("map_half_extent_m", config.map_half_extent_m, {5, 10000},
               "cells farther than this along an axis are forgotten");
  reader.field("map_max_mb", config.map_max_mb, {8, 65536},
               "the farthest cells are forgotten above this size");
  reader.field("max_iterations", config.max_iterations, {1, 50}, "of one update");
  reader.field("gate_sigma", config.gate_sigma, {1, 10}, "residuals beyond this many sigma are left out");
  reader.field("min_residual_sigma_m", config.min_residual_sigma_m, {0.0001, 1},
               "model error of every residual: curvature, roughness");
  reader.field("min_residuals", config.min_residuals, {6, 10000}, "with fewer the group coasts");
  reader.field("max_range_m", config.max_range_m, {1, 1000},
               "farther points are left out of matching and map");
  reader.field("lidar_delay_s", config.lidar_delay_s, {-0.1, 0.1},
               "added to the stamps of rays gives the IMU's time");
  reader.field("camera_delay_s", config.camera_delay_s, {-0.1, 0.1},
               "the same for pictures, beyond the rig's stamp_delay_s");
  reader.field("lidar_delay_sigma_s", config.lidar_delay_sigma_s, {0, 0.05},
               "1 sigma of lidar_delay_s before the start; 0 = held, else found while it drives");
  reader.field("camera_delay_sigma_s", config.camera_delay_sigma_s, {0, 0.05}, "the same of camera_delay_s");
  reader.field("lidar_turn_sigma_rad", config.lidar_turn_sigma_rad, {0, 0.1},
               "1 sigma of the rig's body_from_lidar, each axis; 0 = held, else found while it drives");
  reader.field("lidar_step_sigma_m", config.lidar_step_sigma_m, {0, 0.2}, "the same of its place");
  reader.field("visual", config.visual,
               "pictures update the pose after the LiDAR, where the rig has a camera");
  reader.field("visual_refine_normals", config.visual_refine_normals,
               "visual points take their normals anew from the LiDAR's planes as these learn");
  reader.field("visual_map_max_mb", config.visual_map_max_mb, {1, 4096},
               "the farthest visual points are forgotten above this size");
  reader.field("gaussian_every", config.gaussian_every, {0, 1000},
               "every so many pictures are held against the Gaussian map too, 0 = none");
  reader.field("gaussian_width_px", config.gaussian_width_px, {80, 1280},
               "for that it is drawn at the first halving of the camera at most so wide");
  reader.field("gaussian_depth", config.gaussian_depth, "and the scan's points are held against its depth");
}

// The ranges stand once, in describe(): printing and reading back checks every one of them.
Status validate(const TrackingConfig& config) {
  EDGESPLAT_TRY(const config::ConfigFile file,
                config::ConfigFile::parse(config::to_toml(config), "tracking"));
  TrackingConfig copy;
  return file.read_into(copy);
}

}  // namespace edgesplat::tracking
