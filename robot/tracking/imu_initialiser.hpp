// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/rig.hpp"
#include "robot/sync/measure_group.hpp"
#include "robot/tracking/filter_state.hpp"
#include "robot/tracking/tracking_config.hpp"

#include <optional>
#include <vector>

namespace edgesplat::tracking {

/// Finds gravity and the gyro bias at the first rest: as far as an IMU can tell, since smooth driving looks
/// the same. (A start in motion: see MovingStart.)
class ImuInitialiser {
 public:
  /// Mean of a signal over the samples, and the root of its axes' summed variances.
  struct Spread {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double deviation = 0.0;
  };

  ImuInitialiser(const TrackingConfig& config, const sensor::ImuModel& model)
      : config_(config), model_(model) {}

  /// Takes a group's samples; the belief once the last `init_s` of them were quiet. Samples repeated between
  /// groups count once.
  std::optional<FilterBelief> add(const std::vector<sync::GroupImu>& imu);

 private:
  [[nodiscard]] FilterBelief solve(const Spread& accel, const Spread& gyro) const;
  [[nodiscard]] ErrorMatrix initial_covariance(const FilterState& state, const Spread& accel,
                                               const Spread& gyro) const;
  [[nodiscard]] bool at_rest(const Spread& accel, const Spread& gyro) const;

  TrackingConfig config_;
  sensor::ImuModel model_;
  std::vector<sync::GroupImu> samples_;
};

}  // namespace edgesplat::tracking
