// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/block_loop.hpp"
#include "robot/tracking/filter_state.hpp"
#include "robot/tracking/plane_map.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace edgesplat::tracking {

/// Where to look for a lost pose, around a guess. Roll and pitch are taken from it: the IMU knows them.
struct PoseSearch {
  double radius_m = 3.0;  ///< level
  double height_m = 1.5;
  double heading_rad = 0.2;
};

/// The poses around a guess at which most points of a scan lie on planes of the map, best first, at most
/// `count`. Looks at a grid of half a metre (coarser where that would be more than 20 000 poses) with 200 of
/// the points. Deterministic for any number of threads.
[[nodiscard]] std::vector<geometry::RigidTransform> likely_poses(
    const PlaneMap& map, std::span<const Eigen::Vector3f> points_in_body_m,
    const geometry::RigidTransform& odom_from_body, const PoseSearch& search, BlockLoop& loop,
    std::size_t count);

}  // namespace edgesplat::tracking
