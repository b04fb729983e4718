// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/visual_normal.hpp"

#include <cmath>

namespace edgesplat::tracking {
namespace {

constexpr float kSameDirection = 0.966F;  // cosine of 15 degrees
constexpr float kSamePlace_m = 0.05F;
/// Slants are not followed beyond 80 degrees: a step would grow without bound.
constexpr float kLeastFacing = 0.17F;

}  // namespace

void turn_plane(VisualObservation& observation, const Eigen::Vector3f& normal) {
  const Eigen::Vector3f& ray = observation.from_camera_m;
  // Along the ray, by which the depth grows as the ray does.
  const Eigen::Vector2f along(normal.dot(observation.right_m) / normal.dot(ray),
                              normal.dot(observation.down_m) / normal.dot(ray));
  observation.right_m -= along.x() * ray;
  observation.down_m -= along.y() * ray;
  observation.growth -= along;
}

void refine_normal(VisualMap& map, VisualPoint& point, const PlaneMap& planes) {
  const PlaneMatch match = planes.find(point.p_in_odom_m);
  if (match.plane == nullptr) return;
  Eigen::Vector3f normal = match.plane->normal;
  if (normal.dot(point.normal) < 0.0F) normal = -normal;
  if (normal.dot(point.normal) < kSameDirection) return;
  if (std::abs(normal.dot(match.from_centre_m)) > kSamePlace_m) return;
  for (std::size_t i = 0; i < point.observation_count; ++i) {
    const Eigen::Vector3f& ray = map.observation(point.observations[i]).from_camera_m;
    if (-normal.dot(ray) < kLeastFacing * ray.norm()) return;
  }
  for (std::size_t i = 0; i < point.observation_count; ++i)
    turn_plane(map.observation(point.observations[i]), normal);
  point.normal = normal;
}

}  // namespace edgesplat::tracking
