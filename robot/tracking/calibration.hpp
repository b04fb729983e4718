// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/filter_state.hpp"
#include "robot/tracking/propagation.hpp"

#include <Eigen/Core>

#include <vector>

namespace edgesplat::tracking {

/// How a body moves at a moment.
struct BodyTwist {
  Eigen::Vector3d turn_in_body_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d step_in_odom_mps = Eigen::Vector3d::Zero();
};

/// The mean motion over a path's last `span`, as it would be at the path's end: what all points of a scan
/// move by when their stamps are off.
[[nodiscard]] BodyTwist twist_at_end(const std::vector<PathKnot>& path, nanoseconds span);
/// Where a body that moves like this is `later_s` later.
[[nodiscard]] geometry::RigidTransform moved(const geometry::RigidTransform& odom_from_body,
                                             const BodyTwist& twist, double later_s);
/// The path made longer by uniform motion at both ends, for rays that were fired before or after it.
void lengthen(std::vector<PathKnot>& path, nanoseconds by);

using FullVector = Eigen::Matrix<double, kFullSize, 1>;
/// The error (rotation on the right, position) of the pose that moves what is seen as an error of the
/// calibration does.
using PoseByCalibration = Eigen::Matrix<double, 6, kCalibrationErrors>;

/// Of a scan: its delay, and the LiDAR's mounting.
[[nodiscard]] PoseByCalibration scan_by_calibration(const FilterState& state, const BodyTwist& twist);
/// Of a picture: its delay.
[[nodiscard]] PoseByCalibration picture_by_calibration(const BodyTwist& twist);

/// Errors that last, of a pose that is matched with the map: times the groups that they last for.
[[nodiscard]] Eigen::Matrix<double, 6, 6> lasting_pose_errors();

/// How an update may use the calibration.
struct CalibrationView {
  PoseByCalibration by_calibration = PoseByCalibration::Zero();
  /// Its mean over the last seconds, carried to this pose. By so much of a calibration's error the map is
  /// moved too, since it was drawn with it: what is seen against the map is the rest.
  PoseByCalibration mean_by_calibration = PoseByCalibration::Zero();
  /// Projector on what the motion does not show: only considered (its error counts, but is not learnt).
  CalibrationMatrix frozen = CalibrationMatrix::Identity();
  BodyTwist twist;

  /// Of what is seen against the map by all errors, where the pose's is that of the pose that the map agrees
  /// with (see to_map_pose).
  [[nodiscard]] Eigen::Matrix<double, 6, kFullSize> rows() const;
  /// From errors with that of the pose itself to those with that of the pose that the map agrees with.
  [[nodiscard]] FullVector to_map_pose(const FullVector& error) const;
  [[nodiscard]] FullVector from_map_pose(const FullVector& error) const;
  /// The pose that shows with the calibration `used` what `state` says is there.
  [[nodiscard]] geometry::RigidTransform pose_with(const SensorCalibration& used,
                                                   const FilterState& state) const;
};

/// Where the body was when a picture was taken; `calibration` is null where its stamp is exact.
[[nodiscard]] geometry::RigidTransform odom_from_body_of_picture(const FilterState& state,
                                                                 const CalibrationView* calibration);

}  // namespace edgesplat::tracking
