// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/route.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::simulate {
namespace {

constexpr double kSmoothingSigma_m = 0.6;
constexpr double kSmoothingStep_m = 0.025;  // finer than kDifference_m, or the heading would be a staircase
constexpr int kSmoothingTaps = 60;          // on each side: +-1.5 m
constexpr double kDifference_m = 0.05;

}  // namespace

Result<Route> Route::create(const World::Path& path) {
  if (!(path.speed_mps > 0.0) || !std::isfinite(path.speed_mps)) {
    return fail(Errc::kInvalidArgument, "the world's path has no positive speed");
  }
  Route route;
  route.closed_ = path.closed;
  std::vector<Eigen::Vector3d> corners = path.waypoints_m;
  if (path.closed && !corners.empty()) corners.push_back(corners.front());
  for (const auto& corner : corners) {
    if (!corner.allFinite()) return fail(Errc::kInvalidArgument, "a waypoint of the path is not finite");
    const double step = route.corners_m_.empty() ? 0.0 : (corner - route.corners_m_.back()).norm();
    if (!route.corners_m_.empty() && step < 1e-6) continue;
    route.distances_m_.push_back(route.corners_m_.empty() ? 0.0 : route.distances_m_.back() + step);
    route.corners_m_.push_back(corner);
  }
  if (route.corners_m_.size() < 2) {
    return fail(Errc::kInvalidArgument, "the world's path needs two distinct waypoints");
  }
  return route;
}

Eigen::Vector3d Route::corner_position(double distance_m) const {
  if (closed_) distance_m -= std::floor(distance_m / length_m()) * length_m();
  const auto next = std::upper_bound(distances_m_.begin() + 1, distances_m_.end() - 1, distance_m);
  const auto i = static_cast<std::size_t>(next - distances_m_.begin());
  const double t = (distance_m - distances_m_[i - 1]) / (distances_m_[i] - distances_m_[i - 1]);
  return corners_m_[i - 1] + t * (corners_m_[i] - corners_m_[i - 1]);
}

Eigen::Vector3d Route::position_m(double distance_m) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double total = 0.0;
  for (int tap = -kSmoothingTaps; tap <= kSmoothingTaps; ++tap) {
    const double offset_m = tap * kSmoothingStep_m;
    const double ratio = offset_m / kSmoothingSigma_m;
    const double weight = std::exp(-0.5 * ratio * ratio);
    sum += weight * corner_position(distance_m + offset_m);
    total += weight;
  }
  return sum / total;
}

Eigen::Vector3d Route::direction(double distance_m) const {
  return (position_m(distance_m + kDifference_m) - position_m(distance_m - kDifference_m)).normalized();
}

double Route::curvature(double distance_m) const {
  const Eigen::Vector3d before = direction(distance_m - 0.1);
  const Eigen::Vector3d after = direction(distance_m + 0.1);
  const double turn = std::atan2(before.x() * after.y() - before.y() * after.x(),
                                 before.x() * after.x() + before.y() * after.y());
  return turn / 0.2;
}

}  // namespace edgesplat::simulate
