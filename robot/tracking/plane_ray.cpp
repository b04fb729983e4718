// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/plane_ray.hpp"

#include <cmath>

namespace edgesplat::tracking {
namespace {

constexpr double kNearest_m = 0.5;
constexpr double kFarthest_m = 25.0;
constexpr double kStep_m = 0.2;
constexpr double kMinFacing = 0.17;
constexpr double kMaxAlongSigma_m = 0.1;
constexpr float kSeenAlike = 0.6F;  // cosine
/// A hit must lie within this many standard deviations of its plane's points around their centre.
constexpr float kReachSigma = 2.5F;

/// Distance along the ray to the plane of the cell around a place.
std::optional<double> distance_to(const PlaneMatch& match, const OdomRay& ray,
                                  const Eigen::Vector3d& place_m) {
  const Eigen::Vector3d normal = match.plane->normal.cast<double>();
  const double facing = normal.dot(ray.direction);
  if (std::abs(facing) < kMinFacing) return std::nullopt;
  const Eigen::Vector3d centre_m = place_m - match.from_centre_m.cast<double>();
  return normal.dot(centre_m - ray.origin_m) / facing;
}

}  // namespace

std::optional<PlaneHit> meet_plane(const PlaneMap& map, const OdomRay& ray, const Eigen::Vector3d& guess_m) {
  Eigen::Vector3d place = guess_m;
  // Twice: the first plane may be that of a cell beside the one that is hit.
  for (int round = 0; round < 2; ++round) {
    const PlaneMatch match = map.find(place);
    if (match.plane == nullptr) return std::nullopt;
    const auto distance = distance_to(match, ray, place);
    if (!distance || *distance < kNearest_m) return std::nullopt;
    place = ray.origin_m + *distance * ray.direction;
  }
  const PlaneMatch match = map.find(place);
  if (match.plane == nullptr) return std::nullopt;
  const float above = match.plane->normal.dot(match.from_centre_m);
  const float across = match.from_centre_m.squaredNorm() - above * above;
  if (across > kReachSigma * kReachSigma * match.plane->reach_m2) return std::nullopt;
  const double facing = match.plane->normal.cast<double>().dot(ray.direction);
  const double sigma_m = std::sqrt(static_cast<double>(match.plane->variance_at(match.from_centre_m)));
  if (facing > -kMinFacing || std::abs(static_cast<double>(above)) > 3.0 * sigma_m + 0.01)
    return std::nullopt;
  const double along_m = sigma_m / -facing;
  if (along_m > kMaxAlongSigma_m) return std::nullopt;
  return PlaneHit{place, match.plane->normal, static_cast<float>(along_m), match.plane->seen_from};
}

std::optional<PlaneHit> first_plane(const PlaneMap& map, const OdomRay& ray) {
  for (double distance_m = kNearest_m; distance_m < kFarthest_m; distance_m += kStep_m) {
    const Eigen::Vector3d place = ray.origin_m + distance_m * ray.direction;
    const PlaneMatch match = map.find(place);
    if (match.plane == nullptr) continue;
    const float above = match.plane->normal.dot(match.from_centre_m);
    const double facing = std::abs(match.plane->normal.cast<double>().dot(ray.direction));
    if (static_cast<double>(std::abs(above)) > kStep_m * facing) continue;  // met in another step
    const auto hit = meet_plane(map, ray, place);
    if (!hit) continue;
    const bool seen_alike = -hit->seen_from.dot(ray.direction.cast<float>()) > kSeenAlike;
    return seen_alike ? hit : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace edgesplat::tracking
