// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/scan_update.hpp"

#include "common/base/check.hpp"
#include "robot/tracking/iterated_update.hpp"
#include "robot/tracking/plane_sums.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <cmath>
#include <cstddef>
#include <optional>

namespace edgesplat::tracking {
namespace {

constexpr std::size_t kBlockSize = 128;
/// Cauchy kernel: a residual of this many sigma counts half.
constexpr float kRobustSigma = 2.0F;
/// How fast the gate closes from the prior's doubt to the posterior's: at once, it locks in the first step's
/// matches.
constexpr double kGateShrink = 0.25;
/// Steps smaller than these end the iteration, once they are taken: what is left after them is far less. What
/// is learnt of a calibration are small differences: there it goes on to a third of them.
constexpr double kRotationDone_rad = 7e-5;
constexpr double kPositionDone_m = 7e-4;
constexpr double kDoneCalibrating = 0.3;
/// Patches are trusted up to this many standard deviations of their points beyond the centre.
constexpr float kReachSigma = 3.0F;

using Matrix6f = Eigen::Matrix<float, 6, 6>;

/// What all residuals at one pose share.
struct PoseView {
  Eigen::Matrix3f rotation;
  Eigen::Matrix3d rotation_d;
  Eigen::Vector3d translation_m;
  Matrix6f covariance;
  float model_variance_m2;
};

std::optional<MatchedPoint> linearise(const PlaneMatch& match, std::size_t point, const PoseView& pose,
                                      const ScanView& scan) {
  const Eigen::Vector3f& p_in_body = scan.points_in_body_m[point];
  const Plane& plane = *match.plane;
  const float residual = plane.normal.dot(match.from_centre_m);
  const float across = match.from_centre_m.squaredNorm() - residual * residual;
  if (across > kReachSigma * kReachSigma * plane.reach_m2) return std::nullopt;
  const Eigen::Vector3f normal_in_body = pose.rotation.transpose() * plane.normal;
  MatchedPoint line;
  line.plane = match.plane;
  line.plane_id = match.id;
  line.residual_m = residual;
  line.row.head<3>() = p_in_body.cross(normal_in_body);
  line.row.tail<3>() = plane.normal;
  line.point_variance_m2 = pose.model_variance_m2 + scan.variance_along(point, normal_in_body);
  line.plane_variance_m2 = plane.variance_at(match.from_centre_m);
  line.spread_m2 = line.point_variance_m2 + line.plane_variance_m2 + line.row.dot(pose.covariance * line.row);
  return line;
}

MatchedPoint match_point(std::size_t point, const PoseView& pose, const ScanView& scan, const PlaneMap& map,
                         float gate_squared) {
  const Eigen::Vector3d p_in_odom =
      pose.rotation_d * scan.points_in_body_m[point].cast<double>() + pose.translation_m;
  std::optional<MatchedPoint> line;
  if (const PlaneMatch match = map.find(p_in_odom); match.plane != nullptr) {
    line = linearise(match, point, pose, scan);
  }
  const bool inside = line && line->residual_m * line->residual_m < gate_squared * line->spread_m2;
  if (!inside) {
    if (const PlaneMatch match = map.find_beyond_face(p_in_odom); match.plane != nullptr) {
      const auto beyond = linearise(match, point, pose, scan);
      if (beyond && (!line || std::abs(beyond->residual_m) < std::abs(line->residual_m))) line = beyond;
    }
  }
  return line.value_or(MatchedPoint{});
}

/// The weight of a residual; 0 beyond the gate. All points on a plane see the plane's error alike: of m
/// residuals with own variances s and a common one c, the mean has the variance s / m + c, as if each had
/// s + m c and they were independent.
float weight_of(const MatchedPoint& line, float sharers, float gate_squared) {
  const float chi_squared = line.residual_m * line.residual_m / line.spread_m2;
  if (!(chi_squared < gate_squared)) return 0.0F;
  const float variance_m2 = line.point_variance_m2 + sharers * line.plane_variance_m2;
  return 1.0F / (variance_m2 * (1.0F + chi_squared / (kRobustSigma * kRobustSigma)));
}

/// Projector on the states that a frozen direction holds still: the pose along it, and the velocity; and on
/// what the motion does not show of the calibration.
template <int Errors>
ErrorsMatrix<Errors> frozen_states(const ObservedPart& observed, const ScanView& scan) {
  ErrorsMatrix<Errors> frozen = ErrorsMatrix<Errors>::Zero();
  frozen.template block<3, 3>(kRot, kRot) = observed.frozen_turns;
  frozen.template block<3, 3>(kPos, kPos) = observed.frozen_steps;
  frozen.template block<3, 3>(kVel, kVel) = observed.frozen_steps;
  if constexpr (Errors == kFullSize)
    frozen.template bottomRightCorner<kCalibrationErrors, kCalibrationErrors>() = scan.calibration->frozen;
  return frozen;
}

template <int Errors>
Correction<Errors> correct_by(const ShiftedPrior<Errors>& prior, const ObservedPart& observed,
                              const ScanView& scan) {
  if constexpr (Errors == kFullSize) {
    return correct(prior, scan.calibration->rows(), observed.information, observed.gradient,
                   lasting_pose_errors());
  } else {
    return correct(prior, observed.information, observed.gradient);
  }
}

/// The doubt about where the points are, the calibration's included.
template <int Errors>
Matrix6d doubt_of(const ErrorsMatrix<Errors>& covariance, const ScanView& scan) {
  if constexpr (Errors == kFullSize) {
    const auto rows = scan.calibration->rows();
    return rows * covariance * rows.transpose();
  } else {
    return covariance.template topLeftCorner<6, 6>();
  }
}

}  // namespace

PointToPlane point_to_plane(const geometry::RigidTransform& odom_from_body,
                            const Eigen::Vector3d& p_in_body_m, const Eigen::Vector3d& normal,
                            const Eigen::Vector3d& centre_in_odom_m) {
  PointToPlane result;
  result.residual_m = normal.dot(odom_from_body * p_in_body_m - centre_in_odom_m);
  result.row << p_in_body_m.cross(odom_from_body.rotation.conjugate() * normal), normal;
  return result;
}

double translation_conditioning(const Matrix6d& information) {
  const Eigen::Matrix3d rotation =
      information.block<3, 3>(kRot, kRot) + 1e-9 * (1.0 + information.trace()) * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d cross = information.block<3, 3>(kRot, kPos);
  const Eigen::Matrix3d schur =
      information.block<3, 3>(kPos, kPos) - cross.transpose() * rotation.inverse() * cross;
  const Eigen::Vector3d lambda =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(schur, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(lambda(2) > 0.0)) return 0.0;
  return std::max(0.0, lambda(0) / lambda(2));
}

PlaneResiduals ScanUpdater::evaluate(const geometry::RigidTransform& odom_from_body,
                                     const Matrix6d& pose_covariance, const ScanView& scan,
                                     const PlaneMap& map) {
  PoseView pose;
  pose.rotation_d = odom_from_body.rotation.toRotationMatrix();
  pose.rotation = pose.rotation_d.cast<float>();
  pose.translation_m = odom_from_body.translation_m;
  pose.covariance = pose_covariance.cast<float>();
  pose.model_variance_m2 = config_.min_residual_sigma_m * config_.min_residual_sigma_m;
  const float gate_squared = config_.gate_sigma * config_.gate_sigma;
  const auto points = scan.points_in_body_m;
  matched_.resize(points.size());
  loop_.run(points.size(), kBlockSize, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) matched_[i] = match_point(i, pose, scan, map, gate_squared);
  });
  count_sharers(map);
  partial_.assign(BlockLoop::blocks(points.size(), kBlockSize), PlaneResiduals{});
  loop_.run(points.size(), kBlockSize, [&](std::size_t block, std::size_t first, std::size_t last) {
    PlaneSums sums;
    int matched = 0;
    for (std::size_t i = first; i < last; ++i) {
      const MatchedPoint& line = matched_[i];
      if (line.plane == nullptr) continue;
      ++matched;
      const float weight = weight_of(line, static_cast<float>(sharers_[line.plane_id]), gate_squared);
      if (weight > 0.0F) sums.add(line, points[i], pose.rotation, weight);
    }
    partial_[block] = sums.total(matched);
  });
  PlaneResiduals total;
  for (const PlaneResiduals& part : partial_) {
    total.equations.information += part.equations.information;
    total.equations.gradient += part.equations.gradient;
    total.equations.noise += part.equations.noise;
    total.used += part.used;
    total.matched += part.matched;
    total.squares_m2 += part.squares_m2;
  }
  return total;
}

void ScanUpdater::count_sharers(const PlaneMap& map) {
  sharers_.resize(map.plane_ids());
  for (const MatchedPoint& line : matched_)
    if (line.plane != nullptr) sharers_[line.plane_id] = 0;
  for (const MatchedPoint& line : matched_)
    if (line.plane != nullptr) ++sharers_[line.plane_id];
}

// States along a frozen direction are only considered (Schmidt): planes' errors last from scan to scan, and a
// direction that is seen slightly askew would tell more about it with each. Their rows of the gain are zero,
// which for the optimal gain K and D = K S K' leaves P - D + F D F, F the projector on them.
template <int Errors>
ScanUpdateResult ScanUpdater::run_with(const FilterBelief& prior, const FilterState& start,
                                       const ScanView& scan, const PlaneMap& map) {
  constexpr bool kCalibrates = Errors == kFullSize;
  constexpr double kDone = kCalibrates ? kDoneCalibrating : 1.0;
  ScanUpdateResult result;
  result.belief = prior;
  FilterState present = start;
  double gate_doubt = 1.0;
  const Matrix6d prior_doubt = doubt_of<Errors>(covariance_of<Errors>(prior), scan);
  Matrix6d gate_covariance = prior_doubt;
  for (int i = 0; i < config_.max_iterations; ++i) {
    geometry::RigidTransform pose = present.odom_from_body;
    if constexpr (kCalibrates) pose = scan.calibration->pose_with(start.calibration, present);
    result.last = evaluate(pose, gate_covariance, scan, map);
    result.iterations = i + 1;
    if (result.last.used < config_.min_residuals) return without_update(prior, result);
    ShiftedPrior<Errors> shifted = shift<Errors>(prior, present);
    if constexpr (kCalibrates) shifted.offset = scan.calibration->to_map_pose(shifted.offset);
    result.observed = keep_observed(result.last.equations);
    const ObservedPart& observed = result.observed;
    const Correction<Errors> correction = correct_by<Errors>(shifted, observed, scan);
    const ErrorsMatrix<Errors> frozen = frozen_states<Errors>(observed, scan);
    const bool holds_still = !frozen.isZero(0.0);
    ErrorsVector<Errors> step = shifted.offset + correction.pulled;
    if (holds_still) step -= frozen * correction.pulled;
    if constexpr (kCalibrates) step = scan.calibration->from_map_pose(step);
    if (!step.allFinite()) return without_update(prior, result);
    present = moved_by<Errors>(present, step);
    const ErrorsMatrix<Errors>& learnt = correction.learnt;
    ErrorsMatrix<Errors> posterior = shifted.covariance - learnt;
    if (holds_still) posterior += frozen * learnt * frozen;
    const ErrorsMatrix<Errors> symmetric = 0.5 * (posterior + posterior.transpose());
    set_covariance<Errors>(result.belief, symmetric);
    gate_doubt *= kGateShrink;
    gate_covariance = doubt_of<Errors>(symmetric, scan) + gate_doubt * prior_doubt;
    result.updated = true;
    if (step.template segment<3>(kRot).norm() < kDone * kRotationDone_rad &&
        step.template segment<3>(kPos).norm() < kDone * kPositionDone_m)
      break;
  }
  result.belief.state = present;
  result.translation_conditioning = translation_conditioning(result.last.equations.information);
  return result;
}

ScanUpdateResult ScanUpdater::run(const FilterBelief& prior, const FilterState& start, const ScanView& scan,
                                  const PlaneMap& map) {
  EDGESPLAT_CHECK(prior.calibration.has_value() == (scan.calibration != nullptr),
                  "a doubted calibration has a view");
  return prior.calibration ? run_with<kFullSize>(prior, start, scan, map)
                           : run_with<kErrorSize>(prior, start, scan, map);
}

}  // namespace edgesplat::tracking
