// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/rig.hpp"
#include "robot/sync/measure_group.hpp"
#include "robot/tracking/gaussian_view.hpp"
#include "robot/tracking/tracked_group.hpp"
#include "robot/tracking/tracking_config.hpp"

#include <cstdint>
#include <memory>

namespace edgesplat::tracking {

/// Counters since create(): nothing is dropped uncounted.
struct TrackingCounters {
  std::int64_t groups = 0;
  std::int64_t coasted_groups = 0;       ///< too few residuals: pose from the IMU or constant velocity alone
  std::int64_t misfit_scans = 0;         ///< aligned, but too much of them lay off the map: not believed
  std::int64_t recoveries = 0;           ///< a lost pose was found in the map
  std::int64_t map_restarts = 0;         ///< a lost pose was not found: the map was begun anew
  std::int64_t moving_starts = 0;        ///< the first pose was found without rest
  std::int64_t refused_starts = 0;       ///< starts in motion that contradicted themselves or told too little
  std::int64_t bad_points = 0;           ///< not finite
  std::int64_t out_of_range_points = 0;  ///< nearer or farther than the LiDAR or the config allows
  std::int64_t bad_imu_samples = 0;      ///< not finite or not after the one before
  std::int64_t imu_gaps = 0;             ///< groups of a rig with an IMU whose samples do not cover them
  std::int64_t evicted_cells = 0;        ///< map cells forgotten
  std::int64_t map_bytes = 0;            ///< the map's present size
  std::int64_t unused_pictures = 0;      ///< of another size than the camera's, or nothing to be seen on them
  std::int64_t visual_updates = 0;       ///< groups whose picture was aligned with the map
  std::int64_t visual_points = 0;        ///< in the visual map at present
  std::int64_t visual_map_bytes = 0;     ///< its present size
  std::int64_t gaussian_looks = 0;       ///< pictures that were held against the Gaussian map
  std::int64_t gaussian_updates = 0;     ///< and that the pose was updated with
};

/// LiDAR-inertial odometry: an iterated error-state Kalman filter on a map of probabilistic planes; without
/// an IMU the motion model is constant velocity. Thread-bound and synchronous. Deterministic: the same groups
/// give the same bits for every number of threads. Source: FAST-LIO2 (Xu et al. 2022) for the filter,
/// VoxelMap (Yuan et al. 2022) for the plane map, FAST-LIVO2 (Zheng et al. 2024) for the use of groups that
/// end at an image.
class Tracker {
 public:
  /// kInvalidConfig where a field is out of range.
  static Result<std::unique_ptr<Tracker>> create(const TrackingConfig& config, const sensor::Rig& rig);
  ~Tracker();
  Tracker(const Tracker&) = delete;
  Tracker& operator=(const Tracker&) = delete;

  /// From now on every `gaussian_every`-th picture is held against the Gaussian map too, where the rig has a
  /// camera and an IMU. Null: none any more.
  void look_at(std::shared_ptr<GaussianView> map);

  /// The pose at the group's end, and the group's points seen from there. Until gravity is known the state is
  /// kInitialising. kInvalidArgument, with the state untouched, for a group that ends before or at the end of
  /// the one before, or before its own begin.
  Result<TrackedGroup> track(const sync::MeasureGroup& group);

  [[nodiscard]] TrackingCounters counters() const;

 private:
  struct Impl;
  class MovingStart;
  explicit Tracker(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace edgesplat::tracking
