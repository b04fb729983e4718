// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/moving_start.hpp"

#include "robot/tracking/tracker_impl.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::tracking {
namespace {

/// The first poses of the odometry are those of scans that were deskewed without knowing the speed.
constexpr int kRoughPoses = 3;
/// With more poses in the window every other one is left out: it may grow, its cost may not.
constexpr std::size_t kMaxPoses = 24;
constexpr double kLongestWindow_s = 20.0;
/// Scans kept for the map that the start begins with.
constexpr std::size_t kMaxScans = 12;
constexpr int kGroupsBetweenTries = 3;
/// A body that the scans see to be no faster may be at rest: the first two of them tell it to 0.05.
constexpr double kRestSpeed_mps = 0.15;
constexpr int kGroupsToSeeRest = 2;
/// Of a scan's pose against the map that it is matched with: what its own covariance does not know.
constexpr double kPoseFloor_rad = 1e-3;
constexpr double kPoseFloor_m = 3e-3;

// Scans and gyro alone: without weight and with a force that is always zero the filter's equations are those
// of constant velocity.
sensor::Rig weightless_rig(const TrackingConfig& config, const sensor::Rig& rig) {
  sensor::Rig weightless = rig;
  weightless.camera.reset();
  weightless.imu->accel_noise_mps2_per_sqrt_hz = config.motion_accel_mps2_per_sqrt_hz;
  weightless.imu->accel_bias_walk_mps3_per_sqrt_hz = 0.0;
  return weightless;
}

Eigen::Matrix<double, 6, 6> with_floor(const Eigen::Matrix<double, 6, 6>& covariance) {
  Eigen::Matrix<double, 6, 6> widened = covariance;
  widened.diagonal().head<3>().array() += kPoseFloor_rad * kPoseFloor_rad;
  widened.diagonal().tail<3>().array() += kPoseFloor_m * kPoseFloor_m;
  return widened;
}

}  // namespace

Tracker::MovingStart::MovingStart(const TrackingConfig& config, const sensor::Rig& rig)
    : config_(config), rig_(rig) {
  config_.visual = false;
  config_.lidar_delay_sigma_s = config_.camera_delay_sigma_s = 0.0;
  config_.lidar_turn_sigma_rad = config_.lidar_step_sigma_m = 0.0;
}
Tracker::MovingStart::~MovingStart() = default;

bool Tracker::MovingStart::sees_rest() const {
  if (!odometry_ || !odometry_->belief) return false;
  const TrackingCounters& seen = odometry_->counters;
  if (seen.groups - seen.coasted_groups < kGroupsToSeeRest) return false;
  // Along a tunnel the speed is what it was first thought to be.
  return seen_velocity_mps(odometry_->belief->state, odometry_->unseen_steps).norm() < kRestSpeed_mps;
}

void Tracker::MovingStart::forget() {
  poses_.clear();
  scans_.clear();
  if (imu_.size() > 1) imu_.erase(imu_.begin(), imu_.end() - 1);
}

void Tracker::MovingStart::keep_samples(const std::vector<sync::GroupImu>& imu) {
  if (poses_.empty()) {
    imu_ = imu;
    return;
  }
  for (const sync::GroupImu& sample : imu)
    if (imu_.empty() || sample.stamp > imu_.back().stamp) imu_.push_back(sample);
  auto first = std::lower_bound(imu_.begin(), imu_.end(), poses_.front().stamp,
                                [](const sync::GroupImu& sample, HostTime t) { return sample.stamp < t; });
  if (first != imu_.begin()) imu_.erase(imu_.begin(), std::prev(first));
}

void Tracker::MovingStart::remember(const sync::MeasureGroup& group, const TrackedGroup& tracked) {
  poses_.push_back({group.end, tracked.odom_from_body, with_floor(tracked.pose_covariance)});
  if (poses_.size() > kMaxPoses) {
    std::vector<ScanPose> kept;
    for (std::size_t i = (poses_.size() - 1) % 2; i < poses_.size(); i += 2) kept.push_back(poses_[i]);
    poses_ = std::move(kept);
  }
  while (poses_.back().stamp - poses_.front().stamp > from_seconds(kLongestWindow_s))
    poses_.erase(poses_.begin());
  EarlyScan scan{tracked.odom_from_body, tracked.pose_covariance, {}, {}};
  const auto points = odometry_->sweep.points_in_body_m();
  for (const std::uint32_t i : odometry_->sweep.thinned(config_.map_voxel_m)) {
    scan.points_in_body_m.push_back(points[i]);
    scan.units.push_back(odometry_->sweep.units()[i]);
  }
  scans_.push_back(std::move(scan));
  if (scans_.size() > kMaxScans) scans_.pop_front();
}

std::optional<MovingStartResult> Tracker::MovingStart::add(const sync::MeasureGroup& group,
                                                           const std::vector<sync::GroupImu>& imu) {
  keep_samples(imu);
  if (!begun_at_) begun_at_ = group.end;
  if (!odometry_) {
    if (static_cast<int>(group.points.size()) < config_.min_residuals || imu.empty()) return std::nullopt;
    odometry_ = std::make_unique<Impl>(config_, weightless_rig(config_, rig_), Gravity::kNone);
    matched_groups_ = 0;
  }
  sync::MeasureGroup weightless{group.begin, group.end, group.points, group.has_point_times, imu, {}};
  for (sync::GroupImu& sample : weightless.imu) sample.accel_mps2.setZero();
  const std::int64_t gaps = odometry_->counters.imu_gaps;
  const auto tracked = odometry_->track(weightless);
  if (!tracked) return std::nullopt;
  const TrackingState state = tracked->health.state;
  if (state == TrackingState::kLost) {
    odometry_.reset();
    forget();
    return std::nullopt;
  }
  if (state == TrackingState::kCoasting || odometry_->counters.imu_gaps > gaps) {
    // Neither a pose nor a stretch of samples may be missing in between.
    forget();
    return std::nullopt;
  }
  if (++matched_groups_ <= kRoughPoses) return std::nullopt;
  remember(group, *tracked);
  if (poses_.back().stamp - poses_.front().stamp < from_seconds(config_.init_moving_s)) return std::nullopt;
  if (group.end - *begun_at_ < from_seconds(config_.init_rest_wait_s)) return std::nullopt;
  if (groups_until_retry_-- > 0) return std::nullopt;
  return try_start(group.begin);
}

std::optional<MovingStartResult> Tracker::MovingStart::try_start(HostTime group_begin) {
  InertialAlignment found = align_inertial(poses_, imu_, *rig_.imu,
                                           {.gyro_bias_radps = config_.init_gyro_rate_max_radps,
                                            .speed_mps = config_.init_moving_speed_sigma_mps});
  last_verdict_ = found.verdict;
  if (found.verdict != AlignmentVerdict::kAligned) {
    ++refused_;
    groups_until_retry_ = kGroupsBetweenTries;
    return std::nullopt;
  }
  hold_gravity_norm(found.belief);
  MovingStartResult start;
  geometry::RigidTransform odom_from_local;
  start.belief = levelled(found.belief, odom_from_local);
  scans_.pop_back();
  const Eigen::Matrix3d turn = odom_from_local.rotation.toRotationMatrix();
  for (EarlyScan& scan : scans_) {
    scan.odom_from_body = odom_from_local * scan.odom_from_body;
    scan.pose_covariance.bottomRightCorner<3, 3>() =
        turn * scan.pose_covariance.bottomRightCorner<3, 3>() * turn.transpose();
    start.scans.push_back(std::move(scan));
  }
  // The way through the newest group, from the pose before it.
  const std::size_t before = poses_.size() - 2;
  FilterBelief from = found.belief;
  from.state = found.states[before];
  start.path = predict_with_imu(from, imu_, *rig_.imu, {}, {poses_[before].stamp, poses_.back().stamp}).path;
  std::erase_if(start.path, [&](const PathKnot& knot) { return knot.stamp < group_begin; });
  const geometry::RigidTransform to_odom =
      start.belief.state.odom_from_body * start.path.back().odom_from_body.inverse();
  for (PathKnot& knot : start.path) knot.odom_from_body = to_odom * knot.odom_from_body;
  return start;
}

}  // namespace edgesplat::tracking
