// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/tracker.hpp"

#include "robot/tracking/tracker_impl.hpp"

#include <fmt/format.h>

#include <utility>

namespace edgesplat::tracking {

Tracker::Tracker(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Tracker::~Tracker() = default;

namespace {

/// What is not supported beside delays and mountings that are set or estimated.
Status check_calibration(const TrackingConfig& config, const sensor::Rig& rig) {
  const bool estimates = config.estimates_calibration();
  const bool delayed = config.lidar_delay_s != 0.0 || config.camera_delay_s != 0.0;
  if (!estimates && !delayed) return {};
  if (!rig.imu) {
    return fail(
        Errc::kInvalidConfig,
        fmt::format("rig \"{}\" has no IMU, against which lidar_delay_s, camera_delay_s, their sigmas, "
                    "lidar_turn_sigma_rad and lidar_step_sigma_m are: leave them at 0",
                    rig.name));
  }
  if (config.gaussian_every > 0 && (estimates || config.camera_delay_s != 0.0)) {
    return fail(
        Errc::kInvalidConfig,
        "gaussian_every takes pictures for exactly stamped and the calibration for exact: set it to 0, "
        "or put a known delay into the rig's stamp_delay_s and leave camera_delay_s, the delays' sigmas, "
        "lidar_turn_sigma_rad and lidar_step_sigma_m at 0");
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<Tracker>> Tracker::create(const TrackingConfig& config, const sensor::Rig& rig) {
  EDGESPLAT_TRY_STATUS(validate(config));
  EDGESPLAT_TRY_STATUS(check_calibration(config, rig));
  for (std::size_t unit = 0; unit < rig.lidar_count(); ++unit) {
    const sensor::LidarMount mount = rig.mount_of(unit);
    if (mount.body_from_lidar.is_finite() && mount.model.range_sigma_m > 0.0 &&
        mount.model.bearing_sigma_rad > 0.0)
      continue;
    return fail(Errc::kInvalidConfig,
                fmt::format("LiDAR {} of rig \"{}\" has no usable noise or place: range_sigma_m and "
                            "bearing_sigma_rad must be positive, body_from_lidar finite",
                            unit, rig.name));
  }
  return std::unique_ptr<Tracker>(new Tracker(std::make_unique<Impl>(config, rig)));
}

Result<TrackedGroup> Tracker::track(const sync::MeasureGroup& group) {
  return impl_->track(group);
}

void Tracker::look_at(std::shared_ptr<GaussianView> map) {
  impl_->gaussian_view = std::move(map);
}

TrackingCounters Tracker::counters() const {
  TrackingCounters counters = impl_->counters;
  counters.evicted_cells = impl_->map.evicted_roots();
  counters.map_bytes = static_cast<std::int64_t>(impl_->map.bytes());
  if (impl_->visual) {
    counters.visual_points = static_cast<std::int64_t>(impl_->visual->map().size());
    counters.visual_map_bytes = static_cast<std::int64_t>(impl_->visual->map().bytes());
  }
  counters.refused_starts = impl_->refused_starts();
  return counters;
}

}  // namespace edgesplat::tracking
