// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/map/keyframe.hpp"
#include "common/sensor/image.hpp"

#include <span>

namespace edgesplat::render {

/// Draws points into a picture, far ones first, coloured by distance (red near, blue at max_range_m): shows
/// at a glance whether camera and LiDAR fit together. Points behind the camera or outside are left out.
void draw_points_by_depth(std::span<const map::ColouredPoint> points_in_body,
                          const geometry::RigidTransform& camera_from_body,
                          const geometry::CameraModel& camera, double max_range_m, sensor::ImageRgb8& image);

}  // namespace edgesplat::render
