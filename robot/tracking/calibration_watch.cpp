// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/calibration_watch.hpp"

#include "common/geometry/so3.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace edgesplat::tracking {
namespace {

constexpr double kWindow_s = 4.0;
constexpr std::size_t kLeastMoments = 10;
/// Least scatter of what a unit error moves, root mean square: a delay of 1 ms then moves things by 0.2 mm
/// against each other, a turn of a mrad by 0.5 mm, a step of a cm by 1 mm.
constexpr double kDelayScatter_mps = 0.2;
constexpr double kTurnScatter_m = 0.5;
constexpr double kStepScatter = 0.1;
/// How fast delays may drift: 20 us in a second, 0.15 ms in a minute.
constexpr double kDelayWalk_s_per_sqrt_s = 2e-5;

}  // namespace

void CalibrationWatch::begin(FilterBelief& belief, const geometry::RigidTransform& body_from_lidar,
                             bool with_imu) const {
  belief.calibration.reset();
  belief.state.calibration = {0.0, 0.0, body_from_lidar};
  if (!with_imu) return;
  belief.state.calibration = {config_.lidar_delay_s, config_.camera_delay_s, body_from_lidar};
  if (!estimates()) return;
  CalibrationVector sigma;
  sigma(kLidarDelay) = config_.lidar_delay_sigma_s;
  sigma(kCameraDelay) = config_.camera_delay_sigma_s;
  sigma.segment<3>(kLidarTurn).setConstant(config_.lidar_turn_sigma_rad);
  sigma.segment<3>(kLidarStep).setConstant(config_.lidar_step_sigma_m);
  belief.calibration.emplace().covariance.diagonal() = sigma.cwiseAbs2();
}

void CalibrationWatch::drift(FilterBelief& belief, double dt_s) const {
  if (!belief.calibration) return;
  CalibrationMatrix& covariance = belief.calibration->covariance;
  const double variance = kDelayWalk_s_per_sqrt_s * kDelayWalk_s_per_sqrt_s * dt_s;
  if (config_.lidar_delay_sigma_s > 0.0) covariance(kLidarDelay, kLidarDelay) += variance;
  if (config_.camera_delay_sigma_s > 0.0) covariance(kCameraDelay, kCameraDelay) += variance;
}

void CalibrationWatch::add(HostTime stamp, const FilterState& state, const BodyTwist& scan_twist,
                           const BodyTwist& end_twist) {
  Moment moment{stamp, state.odom_from_body, scan_by_calibration(state, scan_twist)};
  moment.by_calibration.col(kCameraDelay) = picture_by_calibration(end_twist).col(kCameraDelay);
  moments_.push_back(moment);
  while (stamp - moments_.front().stamp > from_seconds(kWindow_s)) moments_.pop_front();
  judge();
}

PoseByCalibration CalibrationWatch::in_odom(const Moment& moment) const {
  const geometry::RigidTransform& pose = moment.odom_from_body;
  PoseByCalibration moved;
  moved.topRows<3>() = pose.rotation.toRotationMatrix() * moment.by_calibration.topRows<3>();
  moved.bottomRows<3>() = moment.by_calibration.bottomRows<3>() +
                          geometry::hat(pose.translation_m - centre_m_) * moved.topRows<3>();
  return moved;
}

PoseByCalibration CalibrationWatch::mean_at(const geometry::RigidTransform& odom_from_body) const {
  PoseByCalibration mean;
  mean.topRows<3>() = odom_from_body.rotation.toRotationMatrix().transpose() * mean_.topRows<3>();
  mean.bottomRows<3>() =
      mean_.bottomRows<3>() - geometry::hat(odom_from_body.translation_m - centre_m_) * mean_.topRows<3>();
  return mean;
}

void CalibrationWatch::judge() {
  frozen_.setIdentity();
  const auto n = static_cast<double>(moments_.size());
  centre_m_.setZero();
  for (const Moment& moment : moments_) centre_m_ += moment.odom_from_body.translation_m / n;
  mean_.setZero();
  for (const Moment& moment : moments_) mean_ += in_odom(moment) / n;
  if (moments_.size() < kLeastMoments) return;
  CalibrationMatrix scatter = CalibrationMatrix::Zero();
  for (const Moment& moment : moments_) {
    PoseByCalibration off = in_odom(moment) - mean_;
    off.topRows<3>() *= kLever_m;
    scatter += off.transpose() * off / n;
    // What a turn moves far away shows only by the accelerometer's direction, too weakly: it must turn
    // things.
    constexpr int kTurn = kLidarTurn;
    scatter.block<3, 3>(kTurn, kTurn) -=
        off.block<3, 3>(3, kTurn).transpose() * off.block<3, 3>(3, kTurn) / n;
  }
  for (const int delay : {kLidarDelay, kCameraDelay})
    if (scatter(delay, delay) > kDelayScatter_mps * kDelayScatter_mps) frozen_(delay, delay) = 0.0;
  for (const auto& [index, least] : {std::pair{kLidarTurn, kTurnScatter_m}, {kLidarStep, kStepScatter}}) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter.block<3, 3>(index, index));
    for (int k = 0; k < 3; ++k)
      if (solver.eigenvalues()(k) > least * least)
        frozen_.block<3, 3>(index, index) -=
            solver.eigenvectors().col(k) * solver.eigenvectors().col(k).transpose();
  }
}

SensorOffsets CalibrationWatch::report(const FilterBelief& belief,
                                       const geometry::RigidTransform& body_from_lidar) const {
  SensorOffsets offsets;
  const SensorCalibration& found = belief.state.calibration;
  const auto sigma = [&](int index, int count) {
    return belief.calibration
               ? std::sqrt(belief.calibration->covariance.diagonal().segment(index, count).sum())
               : 0.0;
  };
  offsets.lidar_delay_s = found.lidar_delay_s;
  offsets.lidar_delay_sigma_s = sigma(kLidarDelay, 1);
  offsets.lidar_delay_frozen = offsets.lidar_delay_sigma_s == 0.0 || frozen_(kLidarDelay, kLidarDelay) > 0.5;
  offsets.camera_delay_s = found.camera_delay_s;
  offsets.camera_delay_sigma_s = sigma(kCameraDelay, 1);
  offsets.camera_delay_frozen =
      offsets.camera_delay_sigma_s == 0.0 || frozen_(kCameraDelay, kCameraDelay) > 0.5;
  offsets.lidar_turn_rad =
      geometry::so3_log(found.body_from_lidar.rotation * body_from_lidar.rotation.conjugate());
  offsets.lidar_turn_sigma_rad = sigma(kLidarTurn, 3);
  offsets.lidar_step_m = found.body_from_lidar.translation_m - body_from_lidar.translation_m;
  offsets.lidar_step_sigma_m = sigma(kLidarStep, 3);
  const auto frozen = [&](int index, double sigma_of_it) {
    return sigma_of_it == 0.0 ? 3 : static_cast<int>(std::lround(frozen_.block<3, 3>(index, index).trace()));
  };
  offsets.frozen_turns = frozen(kLidarTurn, offsets.lidar_turn_sigma_rad);
  offsets.frozen_steps = frozen(kLidarStep, offsets.lidar_step_sigma_m);
  return offsets;
}

}  // namespace edgesplat::tracking
