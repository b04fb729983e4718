// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/inertial_alignment.hpp"
#include "robot/tracking/propagation.hpp"
#include "robot/tracking/tracker.hpp"

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

namespace edgesplat::tracking {

/// A scan that was matched before gravity was known.
struct EarlyScan {
  geometry::RigidTransform odom_from_body;
  Eigen::Matrix<double, 6, 6> pose_covariance;
  std::vector<Eigen::Vector3f> points_in_body_m;  ///< thinned for the map
  std::vector<std::uint8_t> units;                ///< which LiDAR measured them
};

/// What a start in motion gives.
struct MovingStartResult {
  FilterBelief belief;           ///< at the newest group's end, z up
  std::vector<EarlyScan> scans;  ///< oldest first, without the newest group's
  std::vector<PathKnot> path;    ///< through the newest group, in odom
};

/// A start without rest: scans and gyro alone are tracked at constant velocity (an odometry of its own, in a
/// frame of any attitude), and once that went on for long enough, gravity, biases and velocities are found
/// from its poses and the IMU's samples between them. What contradicts itself is refused, and gathered on.
/// Single-owner.
class Tracker::MovingStart {
 public:
  MovingStart(const TrackingConfig& config, const sensor::Rig& rig);
  ~MovingStart();

  /// A group with its good IMU samples; the start once there is one.
  std::optional<MovingStartResult> add(const sync::MeasureGroup& group,
                                       const std::vector<sync::GroupImu>& imu);
  /// The scans show no motion either, where they show anything. False without scans: a body that rolls
  /// smoothly feels like one at rest.
  [[nodiscard]] bool sees_rest() const;
  [[nodiscard]] std::int64_t refused() const { return refused_; }
  [[nodiscard]] AlignmentVerdict last_verdict() const { return last_verdict_; }

 private:
  void remember(const sync::MeasureGroup& group, const TrackedGroup& tracked);
  void keep_samples(const std::vector<sync::GroupImu>& imu);
  void forget();
  [[nodiscard]] std::optional<MovingStartResult> try_start(HostTime group_begin);

  TrackingConfig config_;
  sensor::Rig rig_;
  std::unique_ptr<Impl> odometry_;    ///< from the first group with points on
  std::optional<HostTime> begun_at_;  ///< waiting for rest
  int matched_groups_ = 0;
  std::vector<ScanPose> poses_;
  std::deque<EarlyScan> scans_;
  std::vector<sync::GroupImu> imu_;
  int groups_until_retry_ = 0;
  std::int64_t refused_ = 0;
  AlignmentVerdict last_verdict_ = AlignmentVerdict::kTooFewPoses;
};

}  // namespace edgesplat::tracking
