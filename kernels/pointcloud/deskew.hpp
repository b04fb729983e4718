// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/rigid_transform.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <span>

namespace edgesplat::pointcloud {

/// Where the sensor was at one moment before the end of a sweep.
struct MotionKnot {
  std::int32_t before_end_ns = 0;
  geometry::RigidTransform end_from_sensor;  ///< maps a point measured then to the frame wanted at the end
};

/// Moves every point to the frame of the sweep's end: rotation and translation between two knots run at
/// constant rate. Knots: oldest first, at least one, turning at most 0.1 rad between two (the series for the
/// rotation is then exact to 5e-6 of the range). A time outside the knots takes the nearest knot. `moved` has
/// the size of `points`; it may be the same memory. Fast when points are roughly in order of time.
/// Thread-safe.
void deskew(std::span<const Eigen::Vector3f> points, std::span<const std::int32_t> before_end_ns,
            std::span<const MotionKnot> knots, std::span<Eigen::Vector3f> moved);

}  // namespace edgesplat::pointcloud
