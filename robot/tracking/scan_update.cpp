// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/scan_update.hpp"

#include "robot/tracking/iterated_update.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <cmath>
#include <optional>

namespace edgesplat::tracking {
namespace {

constexpr std::size_t kBlockSize = 128;
/// Cauchy kernel: a residual of this many sigma counts half.
constexpr float kRobustSigma = 2.0F;
/// Neighbouring points share the error of their plane: they count as this part of independent ones. Measured:
/// the error stays near the stated covariance in simulation, where the full weight states six times too
/// little.
constexpr float kIndependentShare = 0.25F;
/// How fast the gate closes from the prior's doubt to the posterior's: at once, it locks in the first step's
/// matches.
constexpr double kGateShrink = 0.25;
/// Steps smaller than these end the iteration: a hundredth of what one scan can resolve.
constexpr double kRotationDone_rad = 2e-5;
constexpr double kPositionDone_m = 2e-4;
/// Patches are trusted up to this many standard deviations of their points beyond the centre.
constexpr float kReachSigma = 3.0F;

using Matrix6f = Eigen::Matrix<float, 6, 6>;
using Vector6f = Eigen::Matrix<float, 6, 1>;

struct Linearised {
  float residual_m;
  float variance_m2;  ///< of the point and the plane, without the pose
  float spread_m2;    ///< with the pose
  Vector6f row;
  Matrix6f row_covariance;  ///< of the row, the normal being uncertain
};

/// What all residuals at one pose share.
struct PoseView {
  Eigen::Matrix3f rotation;
  Eigen::Matrix3d rotation_d;
  Eigen::Vector3d translation_m;
  Matrix6f covariance;
  float model_variance_m2;
};

std::optional<Linearised> linearise(const PlaneMatch& match, const Eigen::Vector3f& p_in_body,
                                    const PoseView& pose, const ScanView& scan) {
  const Plane& plane = *match.plane;
  const float residual = plane.normal.dot(match.from_centre_m);
  const float across = match.from_centre_m.squaredNorm() - residual * residual;
  if (across > kReachSigma * kReachSigma * plane.reach_m2) return std::nullopt;
  const Eigen::Vector3f normal_in_body = pose.rotation.transpose() * plane.normal;
  Linearised line;
  line.residual_m = residual;
  line.row.head<3>() = p_in_body.cross(normal_in_body);
  line.row.tail<3>() = plane.normal;
  line.variance_m2 = pose.model_variance_m2 + plane.variance_at(match.from_centre_m) +
                     scan.noise->variance_along(p_in_body - scan.lidar_in_body_m, normal_in_body);
  line.spread_m2 = line.variance_m2 + line.row.dot(pose.covariance * line.row);
  // The row is linear in the normal: (hat(p) R', I) n.
  Eigen::Matrix3f lever;
  lever << 0.0F, -p_in_body.z(), p_in_body.y(), p_in_body.z(), 0.0F, -p_in_body.x(), -p_in_body.y(),
      p_in_body.x(), 0.0F;
  lever *= pose.rotation.transpose();
  const Eigen::Matrix3f normal_covariance = unpack(plane.normal_covariance);
  line.row_covariance.topRightCorner<3, 3>() = lever * normal_covariance;
  line.row_covariance.topLeftCorner<3, 3>() = line.row_covariance.topRightCorner<3, 3>() * lever.transpose();
  line.row_covariance.bottomRightCorner<3, 3>() = normal_covariance;
  line.row_covariance.bottomLeftCorner<3, 3>() = line.row_covariance.topRightCorner<3, 3>().transpose();
  return line;
}

void accumulate(const Linearised& line, float gate_squared, PlaneResiduals& sums) {
  const float chi_squared = line.residual_m * line.residual_m / line.spread_m2;
  if (!(chi_squared < gate_squared)) return;
  const float weight =
      kIndependentShare / (line.variance_m2 * (1.0F + chi_squared / (kRobustSigma * kRobustSigma)));
  const Vector6d row = line.row.cast<double>();
  sums.equations.information.noalias() += static_cast<double>(weight) * row * row.transpose();
  sums.equations.gradient += static_cast<double>(weight * line.residual_m) * row;
  sums.equations.noise += (weight * line.row_covariance).cast<double>();
  ++sums.used;
  sums.squares_m2 += static_cast<double>(line.residual_m) * static_cast<double>(line.residual_m);
}

PlaneResiduals sum_block(std::span<const Eigen::Vector3f> points, const PoseView& pose, const ScanView& scan,
                         const PlaneMap& map, float gate_squared) {
  PlaneResiduals sums;
  for (const Eigen::Vector3f& p_in_body : points) {
    const Eigen::Vector3d p_in_odom = pose.rotation_d * p_in_body.cast<double>() + pose.translation_m;
    std::optional<Linearised> line;
    if (const PlaneMatch match = map.find(p_in_odom); match.plane != nullptr) {
      line = linearise(match, p_in_body, pose, scan);
    }
    const bool inside = line && line->residual_m * line->residual_m < gate_squared * line->spread_m2;
    if (!inside) {
      if (const PlaneMatch match = map.find_beyond_face(p_in_odom); match.plane != nullptr) {
        const auto beyond = linearise(match, p_in_body, pose, scan);
        if (beyond && (!line || std::abs(beyond->residual_m) < std::abs(line->residual_m))) line = beyond;
      }
    }
    if (!line) continue;
    ++sums.matched;
    accumulate(*line, gate_squared, sums);
  }
  return sums;
}

/// Projector on the states that a frozen direction holds still: the pose along it, and the velocity.
ErrorMatrix frozen_states(const ObservedPart& observed) {
  ErrorMatrix frozen = ErrorMatrix::Zero();
  frozen.block<3, 3>(kRot, kRot) = observed.frozen_turns;
  frozen.block<3, 3>(kPos, kPos) = observed.frozen_steps;
  frozen.block<3, 3>(kVel, kVel) = observed.frozen_steps;
  return frozen;
}

ScanUpdateResult without_update(const FilterBelief& prior, ScanUpdateResult result) {
  result.belief = prior;
  result.updated = false;
  return result;
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
  partial_.assign(BlockLoop::blocks(points.size(), kBlockSize), PlaneResiduals{});
  loop_.run(points.size(), kBlockSize, [&](std::size_t block, std::size_t first, std::size_t last) {
    partial_[block] = sum_block(points.subspan(first, last - first), pose, scan, map, gate_squared);
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

// States along a frozen direction are only considered (Schmidt): planes' errors last from scan to scan, and a
// direction that is seen slightly askew would tell more about it with each. Their rows of the gain are zero,
// which for the optimal gain K and D = K S K' leaves P - D + F D F, F the projector on them.
ScanUpdateResult ScanUpdater::run(const FilterBelief& prior, const FilterState& start, const ScanView& scan,
                                  const PlaneMap& map) {
  ScanUpdateResult result;
  result.belief = prior;
  FilterState present = start;
  double gate_doubt = 1.0;
  Matrix6d gate_covariance = prior.covariance.topLeftCorner<6, 6>();
  for (int i = 0; i < config_.max_iterations; ++i) {
    result.last = evaluate(present.odom_from_body, gate_covariance, scan, map);
    result.iterations = i + 1;
    if (result.last.used < config_.min_residuals) return without_update(prior, result);
    const ShiftedPrior shifted = shift(prior, present);
    result.observed = keep_observed(result.last.equations);
    const ObservedPart& observed = result.observed;
    const Correction correction = correct<6>(shifted, observed.information, observed.gradient);
    const ErrorMatrix frozen = frozen_states(observed);
    const ErrorVector step = shifted.offset + correction.pulled - frozen * correction.pulled;
    if (!step.allFinite()) return without_update(prior, result);
    present = plus(present, step);
    const ErrorMatrix& learnt = correction.learnt;
    const ErrorMatrix posterior = shifted.covariance - learnt + frozen * learnt * frozen;
    result.belief.covariance = 0.5 * (posterior + posterior.transpose());
    gate_doubt *= kGateShrink;
    gate_covariance =
        result.belief.covariance.topLeftCorner<6, 6>() + gate_doubt * prior.covariance.topLeftCorner<6, 6>();
    result.updated = true;
    if (step.segment<3>(kRot).norm() < kRotationDone_rad && step.segment<3>(kPos).norm() < kPositionDone_m)
      break;
  }
  result.belief.state = present;
  result.translation_conditioning = translation_conditioning(result.last.equations.information);
  return result;
}

}  // namespace edgesplat::tracking
