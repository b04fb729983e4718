// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/accuracy/evaluation.hpp"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace edgesplat::accuracy {
namespace {

using geometry::RigidTransform;

double angle_rad(const Eigen::Quaterniond& rotation) {
  return 2.0 * std::atan2(rotation.vec().norm(), std::abs(rotation.w()));
}

/// Error of the estimated motion between two moments.
RigidTransform motion_error(const PosePair& first, const PosePair& last) {
  const RigidTransform reference = first.reference.inverse() * last.reference;
  const RigidTransform estimate = first.estimate.inverse() * last.estimate;
  return reference.inverse() * estimate;
}

RelativeErrors relative_errors(std::span<const PosePair> pairs, std::span<const std::size_t> knots) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  std::vector<double> translations_m;
  std::vector<double> rotations_deg;
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const RigidTransform error = motion_error(pairs[knots[i - 1]], pairs[knots[i]]);
    translations_m.push_back(error.translation_m.norm());
    rotations_deg.push_back(angle_rad(error.rotation) * kDegrees);
  }
  return {statistics_of(std::move(translations_m)), statistics_of(std::move(rotations_deg))};
}

/// Distance along the reference from the first pair to each.
std::vector<double> distances_along_reference_m(std::span<const PosePair> pairs) {
  std::vector<double> distances(pairs.size(), 0.0);
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    distances[i] =
        distances[i - 1] + (pairs[i].reference.translation_m - pairs[i - 1].reference.translation_m).norm();
  }
  return distances;
}

}  // namespace

ErrorStatistics statistics_of(std::vector<double> errors) {
  ErrorStatistics result;
  result.count = errors.size();
  if (errors.empty()) return result;
  const auto n = static_cast<double>(errors.size());
  result.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / n;
  double squares = 0.0;
  double deviations = 0.0;
  for (const double error : errors) {
    squares += error * error;
    deviations += (error - result.mean) * (error - result.mean);
  }
  result.rmse = std::sqrt(squares / n);
  result.stddev = std::sqrt(deviations / n);
  std::sort(errors.begin(), errors.end());
  const std::size_t middle = errors.size() / 2;
  result.median = errors.size() % 2 == 1 ? errors[middle] : 0.5 * (errors[middle - 1] + errors[middle]);
  result.min = errors.front();
  result.max = errors.back();
  return result;
}

RigidTransform align(std::span<const PosePair> pairs) {
  if (pairs.empty()) return {};
  Eigen::Vector3d mean_estimate = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_reference = Eigen::Vector3d::Zero();
  for (const PosePair& pair : pairs) {
    mean_estimate += pair.estimate.translation_m;
    mean_reference += pair.reference.translation_m;
  }
  mean_estimate /= static_cast<double>(pairs.size());
  mean_reference /= static_cast<double>(pairs.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const PosePair& pair : pairs) {
    covariance += (pair.reference.translation_m - mean_reference) *
                  (pair.estimate.translation_m - mean_estimate).transpose();
  }
  RigidTransform reference_from_estimate;
  if (pairs.size() > 1) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d signs = Eigen::Vector3d::Ones();
    if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs.z() = -1.0;
    const Eigen::Matrix3d rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    reference_from_estimate.rotation = Eigen::Quaterniond(rotation).normalized();
  }
  reference_from_estimate.translation_m = mean_reference - reference_from_estimate.rotation * mean_estimate;
  return reference_from_estimate;
}

std::vector<double> absolute_errors_m(std::span<const PosePair> pairs,
                                      const RigidTransform& reference_from_estimate) {
  std::vector<double> errors;
  errors.reserve(pairs.size());
  for (const PosePair& pair : pairs) {
    errors.push_back(
        (reference_from_estimate * pair.estimate.translation_m - pair.reference.translation_m).norm());
  }
  return errors;
}

RelativeErrors relative_errors_per_frame(std::span<const PosePair> pairs) {
  std::vector<std::size_t> knots(pairs.size());
  std::iota(knots.begin(), knots.end(), std::size_t{0});
  return relative_errors(pairs, knots);
}

RelativeErrors relative_errors_per_distance(std::span<const PosePair> pairs, double distance_m) {
  if (pairs.empty()) return {};
  std::vector<std::size_t> knots{0};
  double walked_m = 0.0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    walked_m += (pairs[i].reference.translation_m - pairs[i - 1].reference.translation_m).norm();
    if (walked_m < distance_m) continue;
    knots.push_back(i);
    walked_m = 0.0;
  }
  return relative_errors(pairs, knots);
}

EndToEndError end_to_end_error(std::span<const PosePair> pairs) {
  if (pairs.empty()) return {};
  const RigidTransform reference_from_estimate = pairs.front().reference * pairs.front().estimate.inverse();
  EndToEndError result;
  result.distance_m =
      (reference_from_estimate * pairs.back().estimate.translation_m - pairs.back().reference.translation_m)
          .norm();
  const double path_m = reference_path_m(pairs);
  if (path_m > 0.0) result.percent_of_path = 100.0 * result.distance_m / path_m;
  return result;
}

std::optional<KittiErrors> kitti_errors(std::span<const PosePair> pairs, std::span<const double> lengths_m) {
  constexpr std::size_t kStartStep = 10;
  const std::vector<double> distances_m = distances_along_reference_m(pairs);
  KittiErrors sum;
  for (std::size_t first = 0; first < pairs.size(); first += kStartStep) {
    for (const double length_m : lengths_m) {
      const auto end = std::upper_bound(distances_m.begin() + static_cast<std::ptrdiff_t>(first),
                                        distances_m.end(), distances_m[first] + length_m);
      if (end == distances_m.end()) continue;
      const auto last = static_cast<std::size_t>(end - distances_m.begin());
      const RigidTransform error = motion_error(pairs[first], pairs[last]);
      sum.translation_percent += 100.0 * error.translation_m.norm() / length_m;
      sum.rotation_deg_per_m += angle_rad(error.rotation) * 180.0 / std::numbers::pi / length_m;
      ++sum.segments;
    }
  }
  if (sum.segments == 0) return std::nullopt;
  sum.translation_percent /= static_cast<double>(sum.segments);
  sum.rotation_deg_per_m /= static_cast<double>(sum.segments);
  return sum;
}

double reference_path_m(std::span<const PosePair> pairs) {
  return pairs.empty() ? 0.0 : distances_along_reference_m(pairs).back();
}

Result<Evaluation> evaluate(std::span<const PosePair> pairs) {
  if (pairs.size() < 2) {
    return fail(Errc::kInvalidArgument,
                "only " + std::to_string(pairs.size()) +
                    " poses of the two trajectories have a partner in time: are both on the same clock?");
  }
  Evaluation result;
  result.pairs = pairs.size();
  result.duration_s = to_seconds(pairs.back().stamp - pairs.front().stamp);
  result.path_m = reference_path_m(pairs);
  result.reference_from_estimate = align(pairs);
  result.absolute_m = statistics_of(absolute_errors_m(pairs, result.reference_from_estimate));
  result.per_frame = relative_errors_per_frame(pairs);
  result.per_metre = relative_errors_per_distance(pairs, 1.0);
  result.end_to_end = end_to_end_error(pairs);
  result.kitti = kitti_errors(pairs);
  return result;
}

}  // namespace edgesplat::accuracy
