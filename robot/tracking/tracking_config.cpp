// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/tracking_config.hpp"

#include <fmt/format.h>

#include <string_view>

namespace edgesplat::tracking {
namespace {

struct Range {
  std::string_view field;
  double value;
  double low;
  double high;
};

Status check(const Range& range) {
  if (range.value >= range.low && range.value <= range.high) return {};
  return fail(Errc::kInvalidConfig,
              fmt::format("tracking.{} = {} is outside [{}, {}]: correct the configuration", range.field,
                          range.value, range.low, range.high));
}

}  // namespace

Status validate(const TrackingConfig& config) {
  const Range ranges[] = {
      {"threads", static_cast<double>(config.threads), 1, 64},
      {"init_s", config.init_s, 0.05, 10},
      {"init_accel_spread_max_mps2", config.init_accel_spread_max_mps2, 1e-6, 10},
      {"init_gyro_rate_max_radps", config.init_gyro_rate_max_radps, 1e-6, 1},
      {"init_moving_speed_sigma_mps", config.init_moving_speed_sigma_mps, 1e-3, 50},
      {"motion_accel_mps2_per_sqrt_hz", config.motion_accel_mps2_per_sqrt_hz, 1e-3, 100},
      {"motion_turn_radps2_per_sqrt_hz", config.motion_turn_radps2_per_sqrt_hz, 1e-3, 100},
      {"scan_voxel_m", config.scan_voxel_m, 0.01, 5},
      {"map_voxel_m", config.map_voxel_m, 0.01, 5},
      {"max_scan_points", static_cast<double>(config.max_scan_points), 100, 100000},
      {"root_voxel_m", config.root_voxel_m, 0.1, 10},
      {"max_layer", static_cast<double>(config.max_layer), 0, 4},
      {"plane_sigma_max_m", config.plane_sigma_max_m, 0.001, 1},
      {"plane_min_points", static_cast<double>(config.plane_min_points), 5, 32},
      {"plane_freeze_points", static_cast<double>(config.plane_freeze_points), 8, 100000},
      {"map_half_extent_m", config.map_half_extent_m, 5, 10000},
      {"map_max_mb", static_cast<double>(config.map_max_mb), 8, 65536},
      {"max_iterations", static_cast<double>(config.max_iterations), 1, 50},
      {"gate_sigma", config.gate_sigma, 1, 10},
      {"min_residual_sigma_m", config.min_residual_sigma_m, 0.0001, 1},
      {"min_residuals", static_cast<double>(config.min_residuals), 6, 10000},
      {"max_range_m", config.max_range_m, 1, 1000},
  };
  for (const Range& range : ranges) EDGESPLAT_TRY_STATUS(check(range));
  return {};
}

}  // namespace edgesplat::tracking
