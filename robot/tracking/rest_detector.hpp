// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/rig.hpp"
#include "robot/sync/measure_group.hpp"
#include "robot/tracking/filter_state.hpp"

#include <span>

namespace edgesplat::tracking {

/// Tells from the IMU whether the body stands still. A body that rolls smoothly feels the same as one at
/// rest, so it takes half a second in which not even the floor is felt. Single-owner.
class RestDetector {
 public:
  explicit RestDetector(const sensor::ImuModel& model) : model_(model) {}

  /// Takes a group's samples and the state at its end. True when every group of the last half second was
  /// quiet.
  bool add(std::span<const sync::GroupImu> imu, const FilterState& state);

 private:
  [[nodiscard]] bool is_quiet(std::span<const sync::GroupImu> imu, const FilterState& state) const;

  sensor::ImuModel model_;
  double quiet_s_ = 0.0;
};

/// The velocity without what it is along the directions of a projector, which nothing sees.
[[nodiscard]] Eigen::Vector3d seen_velocity_mps(const FilterState& state, const Eigen::Matrix3d& unseen);
/// A measurement that the velocity is zero along the directions of a projector.
void hold_velocity(FilterBelief& belief, const Eigen::Matrix3d& directions_in_odom, double sigma_mps);

}  // namespace edgesplat::tracking
