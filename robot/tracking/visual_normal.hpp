// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/plane_map.hpp"
#include "robot/tracking/visual_map.hpp"

namespace edgesplat::tracking {

/// Turns an observation's steps on its plane to another plane through the same point. Exact: a step and what
/// is left of it along the ray look the same in the picture.
void turn_plane(VisualObservation& observation, const Eigen::Vector3f& normal);

/// Takes the point's normal anew from the LiDAR's plane there, which has learnt since the point was made, and
/// turns its observations with it (FAST-LIVO2, V-E, refines it by the pictures instead). Leaves a point whose
/// plane is gone, or another one: more than 15 degrees turned or 5 cm away.
void refine_normal(VisualMap& map, VisualPoint& point, const PlaneMap& planes);

}  // namespace edgesplat::tracking
