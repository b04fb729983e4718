// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/mapping/ground.hpp"
#include "kernels/mapping/pixel_points.hpp"
#include "kernels/mapping/stored_view.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace edgesplat::mapping {

struct SweepOptions {
  bool enabled = true;
  int stride_px = 2;          ///< every so many pixels get a point, 1..32
  float max_alpha = 0.5F;     ///< pixels that the map covers less are asked for, 0..1
  float nearest_m = 3.0F;     ///< depths are tried from here, 0.5..50 ...
  float farthest_m = 120.0F;  ///< ... to here, where what shows no parallax is put, 10..1000
  int depths = 32;            ///< so many, evenly in inverse depth, 4..256
  int patch_px = 2;           ///< half side of the patches compared, 1..8
  /// Mean difference of two patches, each without its own mean, up to which they show the same, 0..1
  float max_difference = 0.05F;
  /// A farther depth is as good as the best one when it differs by no more than this, 0..1
  float ambiguous = 0.008F;
  std::size_t views = 2;     ///< compared with, 1..8
  float baseline_m = 0.25F;  ///< they lie at least so far apart from the new one, 0.01..10
};

/// The depth of what only the camera sees - over and beside the LiDAR's sight, or beyond its reach: a plane
/// sweep (Collins 1996). For each asked pixel of a grid, depths are tried until the patch around it looks
/// alike in the other views; a pixel that several depths suit gets the farthest (the sky, a blank wall), one
/// that none suits gets nothing (what moves, what is hidden in the other views). A lonely depth takes the
/// median of its neighbours'. Nothing lies beyond the floor (null: not known). `alpha`: [H,W] what the map
/// covers of the view. Deterministic; loops on threads of the caller's arena. Nothing without other views.
[[nodiscard]] std::vector<PixelDepth> sweep_depths(const StoredView& view,
                                                   std::span<const StoredView* const> others,
                                                   const GroundPlane* ground, std::span<const float> alpha,
                                                   const SweepOptions& options);

/// The newest of the views, all of one camera, that see what this one sees from far enough beside it to
/// compare with; newest first.
[[nodiscard]] std::vector<const StoredView*> sweep_partners(const StoredView& view,
                                                            std::span<const StoredView* const> newest_first,
                                                            const SweepOptions& options);

}  // namespace edgesplat::mapping
