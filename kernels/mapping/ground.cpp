// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/ground.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace edgesplat::mapping {
namespace {

/// z = a x + b y + c around the points' centre, so that the numbers stay small.
struct Slope {
  double a, b, c;
};

std::optional<Slope> fit_slope(std::span<const Eigen::Vector3d> points_m, const Eigen::Vector3d& centre_m) {
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points_m) {
    const Eigen::Vector3d row(p.x() - centre_m.x(), p.y() - centre_m.y(), 1.0);
    normal_matrix += row * row.transpose();
    right += row * (p.z() - centre_m.z());
  }
  // Too narrow a strip says nothing about the slope across it: a level floor is the guess then.
  normal_matrix(0, 0) += 0.05 * static_cast<double>(points_m.size());
  normal_matrix(1, 1) += 0.05 * static_cast<double>(points_m.size());
  const Eigen::Vector3d solution = normal_matrix.ldlt().solve(right);
  if (!solution.allFinite()) return std::nullopt;
  return Slope{solution.x(), solution.y(), solution.z()};
}

/// The height with most points within half_band of it.
double best_level(std::vector<double>& heights_m, double half_band_m, std::size_t& support) {
  std::sort(heights_m.begin(), heights_m.end());
  double best = 0.0;
  support = 0;
  std::size_t first = 0;
  for (std::size_t last = 0; last < heights_m.size(); ++last) {
    while (heights_m[last] - heights_m[first] > 2.0 * half_band_m) ++first;
    if (last - first + 1 > support) {
      support = last - first + 1;
      best = 0.5 * (heights_m[first] + heights_m[last]);
    }
  }
  return best;
}

}  // namespace

std::optional<GroundPlane> find_ground(std::span<const map::ColouredPoint> points_in_body,
                                       const geometry::RigidTransform& map_from_body,
                                       const GroundOptions& options) {
  std::vector<Eigen::Vector3d> points_m;
  std::vector<double> heights_m;
  for (const map::ColouredPoint& point : points_in_body) {
    const Eigen::Vector3d p = map_from_body * point.p_in_body_m.cast<double>();
    const double below_m = map_from_body.translation_m.z() - p.z();
    if (!(below_m >= options.below_body_m && below_m <= options.most_below_m)) continue;
    points_m.push_back(p);
    heights_m.push_back(p.z());
  }
  std::size_t support = 0;
  const double level_m = best_level(heights_m, options.band_m, support);
  if (support < static_cast<std::size_t>(options.min_points)) return std::nullopt;

  std::vector<Eigen::Vector3d> floor_m;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points_m) {
    if (std::abs(p.z() - level_m) > options.band_m) continue;
    floor_m.push_back(p);
    centre_m += p;
  }
  centre_m /= static_cast<double>(floor_m.size());
  const auto slope = fit_slope(floor_m, centre_m);
  if (!slope || std::atan(std::hypot(slope->a, slope->b)) > options.max_slope_rad) return std::nullopt;
  GroundPlane ground;
  ground.normal = Eigen::Vector3d(-slope->a, -slope->b, 1.0).normalized();
  ground.offset_m = ground.normal.dot(centre_m + Eigen::Vector3d(0.0, 0.0, slope->c));
  return ground;
}

}  // namespace edgesplat::mapping
