// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/calibration.hpp"
#include "robot/tracking/degeneracy.hpp"
#include "robot/tracking/tracked_group.hpp"
#include "robot/tracking/tracking_config.hpp"

#include <deque>

namespace edgesplat::tracking {

/// Judges from the motion of the last seconds what of the calibration shows in it. An error of the
/// calibration moves what is seen; where it moves everything alike in odom (a delay in a straight or circular
/// way at constant speed, a turn about the axis that the body turns about), the map moves along and nothing
/// tells. So each unit error is carried to odom at each pose, and must scatter there. Single-owner.
class CalibrationWatch {
 public:
  explicit CalibrationWatch(const TrackingConfig& config) : config_(config) {}

  /// Whether anything of the calibration is to be estimated at all.
  [[nodiscard]] bool estimates() const { return config_.estimates_calibration(); }
  /// The doubt at the start; leaves what is not estimated exact, and without an IMU all.
  void begin(FilterBelief& belief, const geometry::RigidTransform& body_from_lidar, bool with_imu) const;
  /// Clocks drift.
  void drift(FilterBelief& belief, double dt_s) const;
  /// A group's state and the motion through it.
  void add(HostTime stamp, const FilterState& state, const BodyTwist& scan_twist, const BodyTwist& end_twist);
  /// Projector on what is not to be learnt now.
  [[nodiscard]] const CalibrationMatrix& frozen() const { return frozen_; }
  /// The mean of what unit errors did to the poses lately, as errors of this pose.
  [[nodiscard]] PoseByCalibration mean_at(const geometry::RigidTransform& odom_from_body) const;
  [[nodiscard]] SensorOffsets report(const FilterBelief& belief,
                                     const geometry::RigidTransform& body_from_lidar) const;

 private:
  struct Moment {
    HostTime stamp{};
    geometry::RigidTransform odom_from_body;
    PoseByCalibration by_calibration;  ///< of the pose; LiDAR and camera delay each by its own motion
  };
  void judge();
  /// Errors of a pose as a turn and, at the centre of the way, a step in odom.
  [[nodiscard]] PoseByCalibration in_odom(const Moment& moment) const;

  TrackingConfig config_;
  std::deque<Moment> moments_;
  Eigen::Vector3d centre_m_ = Eigen::Vector3d::Zero();  ///< of the way
  PoseByCalibration mean_ = PoseByCalibration::Zero();  ///< in odom
  CalibrationMatrix frozen_ = CalibrationMatrix::Identity();
};

}  // namespace edgesplat::tracking
