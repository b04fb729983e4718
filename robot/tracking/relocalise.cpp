// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/relocalise.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace edgesplat::tracking {
namespace {

constexpr std::size_t kPoints = 200;
constexpr double kStep_m = 0.5;
constexpr double kTurnStep_rad = 0.08;
constexpr double kMaxPoses = 20000.0;
/// A point this close to its cell's plane lies on it: wide enough for half a step of the grid.
constexpr float kOnPlane_m = 0.2F;
constexpr std::size_t kBlockSize = 64;

std::vector<double> steps(double reach, double step) {
  std::vector<double> all{0.0};
  for (double at = step; at <= reach + 1e-9; at += step) {
    all.push_back(at);
    all.push_back(-at);
  }
  return all;
}

std::vector<geometry::RigidTransform> candidates(const geometry::RigidTransform& guess,
                                                 const PoseSearch& search) {
  const std::vector<double> turns = steps(search.heading_rad, kTurnStep_rad);
  const std::vector<double> heights = steps(search.height_m, kStep_m);
  const double side = 2.0 * search.radius_m;
  const double finest = side / std::sqrt(kMaxPoses / static_cast<double>(turns.size() * heights.size()));
  const std::vector<double> level = steps(search.radius_m, std::max(kStep_m, finest));
  std::vector<geometry::RigidTransform> poses;
  for (const double turn : turns) {
    const Eigen::Quaterniond rotation = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * guess.rotation;
    for (const double z : heights)
      for (const double x : level)
        for (const double y : level)
          poses.push_back({rotation, guess.translation_m + Eigen::Vector3d(x, y, z)});
  }
  return poses;
}

int points_on_planes(const PlaneMap& map, std::span<const Eigen::Vector3f> points,
                     const geometry::RigidTransform& pose) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  int count = 0;
  for (const Eigen::Vector3f& p : points) {
    const PlaneMatch match = map.find(rotation * p.cast<double>() + pose.translation_m);
    if (match.plane == nullptr) continue;
    count += std::abs(match.plane->normal.dot(match.from_centre_m)) < kOnPlane_m ? 1 : 0;
  }
  return count;
}

}  // namespace

std::vector<geometry::RigidTransform> likely_poses(const PlaneMap& map,
                                                   std::span<const Eigen::Vector3f> points,
                                                   const geometry::RigidTransform& guess,
                                                   const PoseSearch& search, BlockLoop& loop,
                                                   std::size_t count) {
  std::vector<Eigen::Vector3f> few;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kPoints);
  for (std::size_t i = 0; i < points.size(); i += stride) few.push_back(points[i]);
  const std::vector<geometry::RigidTransform> poses = candidates(guess, search);
  std::vector<std::pair<int, std::size_t>> scores(poses.size());
  loop.run(poses.size(), kBlockSize, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) scores[i] = {-points_on_planes(map, few, poses[i]), i};
  });
  std::sort(scores.begin(), scores.end());
  std::vector<geometry::RigidTransform> best;
  for (std::size_t i = 0; i < std::min(count, scores.size()); ++i) best.push_back(poses[scores[i].second]);
  return best;
}

}  // namespace edgesplat::tracking
