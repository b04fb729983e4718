// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/mapping/ground.hpp"
#include "kernels/mapping/stored_view.hpp"

#include <span>
#include <vector>

namespace edgesplat::mapping {

struct HoleFillOptions {
  bool enabled = true;
  int stride_px = 3;         ///< every so many pixels get a point, 1..32
  float max_alpha = 0.92F;   ///< pixels that the map covers less are holes, 0..1
  float max_depth_m = 8.0F;  ///< farther away the LiDAR sees the floor itself, 0.5..50
  GroundOptions ground;
};

/// Where the LiDAR cannot look - the floor at the robot's feet, the foot of a near wall - but the camera
/// does: points for the pixels that the map leaves empty, with the picture's colour. A pixel lies on the
/// floor, or on what was measured above it in its column where that is nearer, as upright things go on
/// downwards. Only pixels that look down onto the floor are filled. `alpha`: [H,W] what the map covers of the
/// view. Points are in the body frame at the view's pose.
[[nodiscard]] std::vector<map::ColouredPoint> fill_holes(const StoredView& view,
                                                         const geometry::RigidTransform& map_from_body,
                                                         const GroundPlane& ground,
                                                         std::span<const float> alpha,
                                                         const HoleFillOptions& options);

}  // namespace edgesplat::mapping
