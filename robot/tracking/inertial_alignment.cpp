// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/inertial_alignment.hpp"

#include "common/geometry/so3.hpp"
#include "robot/tracking/propagation.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>

namespace edgesplat::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix9d = Eigen::Matrix<double, 9, 9>;
using Vector9d = Eigen::Matrix<double, 9, 1>;

constexpr std::size_t kMinPoses = 4;
constexpr int kIterations = 5;
/// Where poses and samples agree this is about 1; poses a centimetre off without saying so make it 10.
constexpr double kMaxChiSquaredPerDof = 4.0;
constexpr double kNormTolerance_mps2 = 0.5;
constexpr double kNormGate = 3.0;
constexpr double kMaxTiltSigma_rad = 0.03;
constexpr double kMaxGyroBiasSigma_radps = 0.02;

// Unknowns: what all poses share, then rotation, position and velocity of each.
constexpr int kSharedGyro = 0, kSharedAccel = 3, kSharedGravity = 6, kShared = 9;
constexpr int kPoseErrors = 9;
Eigen::Index place_of(std::size_t pose) {
  return kShared + kPoseErrors * static_cast<Eigen::Index>(pose);
}

/// What the samples between two poses say, in the frame of the body at the first, without gravity.
struct Preintegrated {
  FilterState moved;                    ///< rotation, step and change of velocity
  Eigen::Matrix<double, 9, 6> by_bias;  ///< of (rotation, step, velocity) by (gyro, accelerometer)
  Matrix9d information;
  double span_s = 0.0;
  bool covered = false;
};

Matrix9d motion_part(const ErrorMatrix& p) {
  Matrix9d part;
  constexpr std::array kParts = {kRot, kPos, kVel};
  for (std::size_t i = 0; i < kParts.size(); ++i)
    for (std::size_t j = 0; j < kParts.size(); ++j)
      part.block<3, 3>(3 * static_cast<Eigen::Index>(i), 3 * static_cast<Eigen::Index>(j)) =
          p.block<3, 3>(kParts[i], kParts[j]);
  return part;
}

// The filter's own propagation, from a body at rest without weight. Biases that begin with unit variance
// leave their derivatives as covariances with the motion; the rest of its covariance is the samples' noise.
Preintegrated preintegrate(const FilterState& biases, std::span<const sync::GroupImu> imu,
                           const sensor::ImuModel& model, Interval interval) {
  FilterBelief belief;
  belief.state.gravity_in_odom_mps2.setZero();
  belief.state.gyro_bias_radps = biases.gyro_bias_radps;
  belief.state.accel_bias_mps2 = biases.accel_bias_mps2;
  belief.covariance.setZero();
  belief.covariance.diagonal().segment<6>(kGyroBias).setOnes();
  const Prediction prediction = predict_with_imu(belief, imu, model, {}, interval);
  const ErrorMatrix& p = prediction.belief.covariance;
  Preintegrated result;
  result.moved = prediction.belief.state;
  result.by_bias << p.block<3, 6>(kRot, kGyroBias), p.block<3, 6>(kPos, kGyroBias),
      p.block<3, 6>(kVel, kGyroBias);
  Matrix9d noise = motion_part(p) - result.by_bias * result.by_bias.transpose();
  noise.diagonal().array() += 1e-12;
  result.information = noise.llt().solve(Matrix9d::Identity());
  result.span_s = to_seconds(interval.end - interval.begin);
  result.covered = prediction.imu_covers;
  return result;
}

/// How far two states are from what the samples between them say.
Vector9d mismatch(const FilterState& from, const FilterState& to, const Preintegrated& between) {
  const Matrix3d body_from_local = from.odom_from_body.rotation.toRotationMatrix().transpose();
  const double t = between.span_s;
  const Vector3d& g = from.gravity_in_odom_mps2;
  Vector9d r;
  r << geometry::so3_log(between.moved.odom_from_body.rotation.conjugate() *
                         from.odom_from_body.rotation.conjugate() * to.odom_from_body.rotation),
      body_from_local * (to.odom_from_body.translation_m - from.odom_from_body.translation_m -
                         t * from.velocity_in_odom_mps - 0.5 * t * t * g) -
          between.moved.odom_from_body.translation_m,
      body_from_local * (to.velocity_in_odom_mps - from.velocity_in_odom_mps - t * g) -
          between.moved.velocity_in_odom_mps;
  return r;
}

struct MismatchRows {
  Matrix9d by_from, by_to, by_shared;
};

MismatchRows rows_of(const FilterState& from, const FilterState& to, const Preintegrated& between,
                     const Vector9d& r) {
  const Matrix3d body_from_local = from.odom_from_body.rotation.toRotationMatrix().transpose();
  const double t = between.span_s;
  MismatchRows rows;
  rows.by_from.setZero();
  rows.by_to.setZero();
  rows.by_shared.setZero();
  const Matrix3d turn = geometry::so3_right_jacobian_inverse(r.head<3>());
  rows.by_from.block<3, 3>(0, 0) =
      -turn * (to.odom_from_body.rotation.conjugate() * from.odom_from_body.rotation).toRotationMatrix();
  rows.by_to.block<3, 3>(0, 0) = turn;
  rows.by_from.block<3, 3>(3, 0) =
      geometry::hat(r.segment<3>(3) + between.moved.odom_from_body.translation_m);
  rows.by_from.block<3, 3>(3, 3) = -body_from_local;
  rows.by_from.block<3, 3>(3, 6) = -t * body_from_local;
  rows.by_to.block<3, 3>(3, 3) = body_from_local;
  rows.by_from.block<3, 3>(6, 0) = geometry::hat(r.tail<3>() + between.moved.velocity_in_odom_mps);
  rows.by_from.block<3, 3>(6, 6) = -body_from_local;
  rows.by_to.block<3, 3>(6, 6) = body_from_local;
  rows.by_shared.leftCols<6>() = -between.by_bias;
  rows.by_shared.block<3, 3>(3, kSharedGravity) = -0.5 * t * t * body_from_local;
  rows.by_shared.block<3, 3>(6, kSharedGravity) = -t * body_from_local;
  return rows;
}

/// The least squares problem of all poses.
class Batch {
 public:
  Batch(std::span<const ScanPose> poses, std::span<const sync::GroupImu> imu, const sensor::ImuModel& model,
        const AlignmentPriors& priors)
      : poses_(poses), imu_(imu), model_(model), priors_(priors) {
    guess();
  }

  /// One step; false where there is none: poses and samples have nothing in common.
  bool step() {
    const Eigen::VectorXd step = -hessian_.llt().solve(gradient_);
    if (!step.allFinite()) return false;
    apply(step);
    return true;
  }
  /// Cost and normal equations at the present states; false over a gap of the samples.
  bool linearise() {
    const Eigen::Index size = place_of(poses_.size());
    hessian_ = Eigen::MatrixXd::Zero(size, size);
    gradient_ = Eigen::VectorXd::Zero(size);
    cost_ = 0.0;
    add_priors();
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      add_pose(i);
      if (i > 0 && !add_samples(i)) return false;
    }
    return true;
  }

  [[nodiscard]] const std::vector<FilterState>& states() const { return states_; }
  [[nodiscard]] double chi_squared_per_dof() const {
    // Residuals of poses and samples less what they determine.
    const auto n = static_cast<double>(poses_.size());
    return cost_ / std::max(1.0, 15.0 * n - 9.0 - static_cast<double>(gradient_.size()));
  }
  /// Of the errors at the last pose.
  [[nodiscard]] FilterBelief last_belief() const {
    const Eigen::Index place = place_of(poses_.size() - 1);
    const Eigen::MatrixXd all =
        hessian_.llt().solve(Eigen::MatrixXd::Identity(hessian_.rows(), hessian_.cols()));
    const std::array<std::pair<int, Eigen::Index>, 6> parts = {{{kRot, place},
                                                                {kPos, place + 3},
                                                                {kVel, place + 6},
                                                                {kGyroBias, kSharedGyro},
                                                                {kAccelBias, kSharedAccel},
                                                                {kGravity, kSharedGravity}}};
    FilterBelief belief{states_.back(), ErrorMatrix::Zero()};
    for (const auto& [row, from_row] : parts)
      for (const auto& [column, from_column] : parts)
        belief.covariance.block<3, 3>(row, column) = all.block<3, 3>(from_row, from_column);
    return belief;
  }

 private:
  /// Velocities from neighbouring poses; gravity from what the mean force leaves.
  void guess() {
    states_.resize(poses_.size());
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const ScanPose& before = poses_[i > 0 ? i - 1 : 0];
      const ScanPose& after = poses_[std::min(i + 1, poses_.size() - 1)];
      states_[i].odom_from_body = poses_[i].local_from_body;
      states_[i].velocity_in_odom_mps =
          (after.local_from_body.translation_m - before.local_from_body.translation_m) /
          to_seconds(after.stamp - before.stamp);
    }
    Vector3d force = Vector3d::Zero();
    double count = 0.0;
    std::size_t pose = 0;
    for (const auto& sample : imu_) {
      if (sample.stamp < poses_.front().stamp || sample.stamp > poses_.back().stamp) continue;
      while (pose + 1 < poses_.size() && poses_[pose + 1].stamp < sample.stamp) ++pose;
      force += poses_[pose].local_from_body.rotation * sample.accel_mps2;
      count += 1.0;
    }
    const double span_s = to_seconds(poses_.back().stamp - poses_.front().stamp);
    const Vector3d gravity =
        (states_.back().velocity_in_odom_mps - states_.front().velocity_in_odom_mps) / span_s -
        force / std::max(1.0, count);
    for (FilterState& state : states_) state.gravity_in_odom_mps2 = gravity;
  }
  void add_priors() {
    const auto add = [&](Eigen::Index place, const Vector3d& value, double sigma) {
      hessian_.diagonal().segment<3>(place).array() += 1.0 / (sigma * sigma);
      gradient_.segment<3>(place) += value / (sigma * sigma);
    };
    add(kSharedGyro, states_[0].gyro_bias_radps, priors_.gyro_bias_radps);
    add(kSharedAccel, states_[0].accel_bias_mps2, priors_.accel_bias_mps2);
    add(kSharedGravity, Vector3d::Zero(), 1e3);  // keeps the problem regular
    for (const std::size_t i : {std::size_t{0}, poses_.size() - 1})
      add(place_of(i) + 6, states_[i].velocity_in_odom_mps, priors_.speed_mps);
  }
  void add_pose(std::size_t i) {
    using Vector6 = Eigen::Matrix<double, 6, 1>;
    using Matrix6 = Eigen::Matrix<double, 6, 6>;
    const geometry::RigidTransform& measured = poses_[i].local_from_body;
    const geometry::RigidTransform& present = states_[i].odom_from_body;
    Vector6 r;
    r << geometry::so3_log(measured.rotation.conjugate() * present.rotation),
        present.translation_m - measured.translation_m;
    const Matrix6 information = poses_[i].covariance.llt().solve(Matrix6::Identity());
    hessian_.block<6, 6>(place_of(i), place_of(i)) += information;
    gradient_.segment<6>(place_of(i)) += information * r;
    cost_ += r.dot(information * r);
  }
  bool add_samples(std::size_t i) {
    const FilterState& from = states_[i - 1];
    const FilterState& to = states_[i];
    const Interval interval{poses_[i - 1].stamp, poses_[i].stamp};
    const auto later = [](const sync::GroupImu& sample, HostTime t) { return sample.stamp <= t; };
    auto first = std::lower_bound(imu_.begin(), imu_.end(), interval.begin, later);
    if (first != imu_.begin()) --first;
    auto last = std::lower_bound(first, imu_.end(), interval.end, later);
    if (last != imu_.end()) ++last;
    if (first == last) return false;
    const Preintegrated between = preintegrate(from, std::span(first, last), model_, interval);
    if (!between.covered) return false;
    const Vector9d r = mismatch(from, to, between);
    const MismatchRows rows = rows_of(from, to, between, r);
    const std::array<std::pair<Eigen::Index, const Matrix9d*>, 3> parts = {
        {{0, &rows.by_shared}, {place_of(i - 1), &rows.by_from}, {place_of(i), &rows.by_to}}};
    const Vector9d pull = between.information * r;
    for (const auto& [row, by_row] : parts) {
      gradient_.segment<9>(row) += by_row->transpose() * pull;
      const Matrix9d weighted = by_row->transpose() * between.information;
      for (const auto& [column, by_column] : parts)
        hessian_.block<9, 9>(row, column) += weighted * *by_column;
    }
    cost_ += r.dot(pull);
    return true;
  }
  void apply(const Eigen::VectorXd& step) {
    for (std::size_t i = 0; i < states_.size(); ++i) {
      ErrorVector error = ErrorVector::Zero();
      error.segment<3>(kRot) = step.segment<3>(place_of(i));
      error.segment<3>(kPos) = step.segment<3>(place_of(i) + 3);
      error.segment<3>(kVel) = step.segment<3>(place_of(i) + 6);
      error.segment<3>(kGyroBias) = step.segment<3>(kSharedGyro);
      error.segment<3>(kAccelBias) = step.segment<3>(kSharedAccel);
      error.segment<3>(kGravity) = step.segment<3>(kSharedGravity);
      states_[i] = plus(states_[i], error);
    }
  }

  std::span<const ScanPose> poses_;
  std::span<const sync::GroupImu> imu_;
  const sensor::ImuModel& model_;
  AlignmentPriors priors_;
  std::vector<FilterState> states_;
  Eigen::MatrixXd hessian_;
  Eigen::VectorXd gradient_;
  double cost_ = 0.0;  ///< squared residuals of poses and samples, the priors apart
};

AlignmentVerdict judge(const InertialAlignment& found) {
  if (!(found.chi_squared_per_dof < kMaxChiSquaredPerDof)) return AlignmentVerdict::kResidual;
  const double off_mps2 = std::abs(found.gravity_mps2 - kGravity_mps2);
  if (!(off_mps2 < std::min(kNormTolerance_mps2,
                            kNormGate * std::hypot(found.gravity_sigma_mps2, kGravityNormSigma_mps2))))
    return AlignmentVerdict::kGravityNorm;
  const double gyro_sigma_radps =
      std::sqrt(found.belief.covariance.diagonal().segment<3>(kGyroBias).maxCoeff());
  if (!(found.tilt_sigma_rad < kMaxTiltSigma_rad && gyro_sigma_radps < kMaxGyroBiasSigma_radps))
    return AlignmentVerdict::kUnobservable;
  return AlignmentVerdict::kAligned;
}

}  // namespace

InertialAlignment align_inertial(std::span<const ScanPose> poses, std::span<const sync::GroupImu> imu,
                                 const sensor::ImuModel& model, const AlignmentPriors& priors) {
  InertialAlignment result;
  if (poses.size() < kMinPoses) return result;
  Batch batch(poses, imu, model, priors);
  result.verdict = AlignmentVerdict::kImuGap;
  if (imu.empty() || !batch.linearise()) return result;
  result.verdict = AlignmentVerdict::kResidual;
  for (int i = 0; i < kIterations; ++i)
    if (!batch.step() || !batch.linearise()) return result;
  result.states = batch.states();
  result.belief = batch.last_belief();
  result.chi_squared_per_dof = batch.chi_squared_per_dof();
  const Vector3d& gravity = result.belief.state.gravity_in_odom_mps2;
  const Matrix3d doubt = result.belief.covariance.block<3, 3>(kGravity, kGravity);
  result.gravity_mps2 = gravity.norm();
  const Vector3d down = gravity.normalized();
  result.gravity_sigma_mps2 = std::sqrt(down.dot(doubt * down));
  const Matrix3d across = Matrix3d::Identity() - down * down.transpose();
  result.tilt_sigma_rad = std::sqrt((across * doubt * across).trace()) / kGravity_mps2;
  result.verdict = judge(result);
  return result;
}

void hold_gravity_norm(FilterBelief& belief) {
  const Vector3d& gravity = belief.state.gravity_in_odom_mps2;
  const Vector3d down = gravity.normalized();
  const ErrorVector column = belief.covariance.middleCols<3>(kGravity) * down;
  const double variance =
      down.dot(column.segment<3>(kGravity)) + kGravityNormSigma_mps2 * kGravityNormSigma_mps2;
  belief.state = plus(belief.state, column * ((kGravity_mps2 - gravity.norm()) / variance));
  belief.covariance -= column * column.transpose() / variance;
}

FilterBelief levelled(const FilterBelief& belief, geometry::RigidTransform& odom_from_local) {
  const FilterState& local = belief.state;
  const Vector3d up_in_body = -(local.odom_from_body.rotation.conjugate() * local.gravity_in_odom_mps2);
  const Eigen::Quaterniond odom_from_body = Eigen::Quaterniond::FromTwoVectors(up_in_body, Vector3d::UnitZ());
  odom_from_local.rotation = odom_from_body * local.odom_from_body.rotation.conjugate();
  odom_from_local.translation_m = -(odom_from_local.rotation * local.odom_from_body.translation_m);
  FilterBelief level = belief;
  level.state.odom_from_body = {odom_from_body, Vector3d::Zero()};
  level.state.velocity_in_odom_mps = odom_from_local.rotation * local.velocity_in_odom_mps;
  level.state.gravity_in_odom_mps2 = odom_from_local.rotation * local.gravity_in_odom_mps2;
  ErrorMatrix turn = ErrorMatrix::Identity();
  for (const int part : {kPos, kVel, kGravity})
    turn.block<3, 3>(part, part) = odom_from_local.rotation.toRotationMatrix();
  level.covariance = turn * belief.covariance * turn.transpose();
  return level;
}

}  // namespace edgesplat::tracking
