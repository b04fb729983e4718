// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/health_csv.hpp"

#include <fmt/format.h>

namespace edgesplat::tracking {

std::string_view name_of(TrackingState state) {
  switch (state) {
    case TrackingState::kInitialising:
      return "initialising";
    case TrackingState::kTracking:
      return "tracking";
    case TrackingState::kDegraded:
      return "degraded";
    case TrackingState::kCoasting:
      return "coasting";
    case TrackingState::kLost:
      return "lost";
    case TrackingState::kRecovered:
      return "recovered";
  }
  return "unknown";
}

std::string_view name_of(GaussianVerdict verdict) {
  switch (verdict) {
    case GaussianVerdict::kNotLooked:
      return "not_looked";
    case GaussianVerdict::kNoMap:
      return "no_map";
    case GaussianVerdict::kNoPicture:
      return "no_picture";
    case GaussianVerdict::kUnlike:
      return "unlike";
    case GaussianVerdict::kContradicts:
      return "contradicts";
    case GaussianVerdict::kUsed:
      return "used";
  }
  return "unknown";
}

namespace {

std::string offsets_csv(const SensorOffsets& offsets) {
  return fmt::format(
      ",{:.3f},{:.3f},{:d},{:.3f},{:.3f},{:d},{:.3f},{:.3f},{},{:.2f},{:.2f},{}", 1e3 * offsets.lidar_delay_s,
      1e3 * offsets.lidar_delay_sigma_s, offsets.lidar_delay_frozen, 1e3 * offsets.camera_delay_s,
      1e3 * offsets.camera_delay_sigma_s, offsets.camera_delay_frozen, 1e3 * offsets.lidar_turn_rad.norm(),
      1e3 * offsets.lidar_turn_sigma_rad, offsets.frozen_turns, 1e3 * offsets.lidar_step_m.norm(),
      1e3 * offsets.lidar_step_sigma_m, offsets.frozen_steps);
}

}  // namespace

std::string_view health_csv_header() {
  return "state,points_used,iterations,residual_rms_m,translation_conditioning,frozen_directions,"
         "weakest_signal,weakest_x,weakest_y,weakest_z,visual_patches,visual_noise_scale,log_gain,"
         "gaussian,gaussian_explained,gaussian_chi_squared,"
         "lidar_delay_ms,lidar_delay_sigma_ms,lidar_delay_frozen,camera_delay_ms,camera_delay_sigma_ms,"
         "camera_delay_frozen,lidar_turn_mrad,lidar_turn_sigma_mrad,frozen_turns,lidar_step_mm,"
         "lidar_step_sigma_mm,frozen_steps";
}

std::string health_csv(const TrackingHealth& health) {
  const Eigen::Vector3d& step = health.weakest.step_in_odom;
  return fmt::format(
             "{},{},{},{:.5f},{:.2e},{},{:.2f},{:.3f},{:.3f},{:.3f},{},{:.2f},{:.3f},{},{:.3f},{:.2f}",
             name_of(health.state), health.points_used, health.iterations, health.residual_rms_m,
             health.translation_conditioning, health.frozen_directions, health.weakest.signal, step.x(),
             step.y(), step.z(), health.visual_patches, health.visual_noise_scale, health.log_gain,
             name_of(health.gaussian), health.gaussian_explained, health.gaussian_chi_squared) +
         offsets_csv(health.offsets);
}

}  // namespace edgesplat::tracking
