// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/plane_map.hpp"

#include <Eigen/Core>

#include <optional>

namespace edgesplat::tracking {

struct PlaneHit {
  Eigen::Vector3d p_in_odom_m;
  Eigen::Vector3f normal;     ///< towards the ray's origin
  float along_sigma_m;        ///< of the hit, along the ray
  Eigen::Vector3f seen_from;  ///< unit vector to the LiDAR that saw the plane
};

struct OdomRay {
  Eigen::Vector3d origin_m;
  Eigen::Vector3d direction;  ///< unit
};

/// Where a ray meets the plane of the cell around `guess_m`, and the cell there agrees. Nothing at a slant of
/// more than 80 degrees, from behind, or where the plane's own error would move the hit by more than 10 cm.
[[nodiscard]] std::optional<PlaneHit> meet_plane(const PlaneMap& map, const OdomRay& ray,
                                                 const Eigen::Vector3d& guess_m);
/// The first plane of the map along a ray (FAST-LIVO2, V-C: ray casting on demand): looks into the map every
/// 0.2 m, up to 25 m. Nothing where it was seen from more than 53 degrees beside: what the LiDAR never saw
/// may hide it, as a floor hides the wall of the storey below.
[[nodiscard]] std::optional<PlaneHit> first_plane(const PlaneMap& map, const OdomRay& ray);

}  // namespace edgesplat::tracking
