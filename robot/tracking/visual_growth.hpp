// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/image/gray_pyramid.hpp"
#include "robot/tracking/plane_ray.hpp"
#include "robot/tracking/visual_selection.hpp"
#include "robot/tracking/visual_update.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::tracking {

/// A picture whose pose is known.
struct PosedPicture {
  const image::GrayPyramid& pyramid;
  const CameraView& view;
  float log_gain;
};

/// Counts for each selected point whether it looked as expected, gives it an observation where the view is a
/// new one, and forgets points that do not match three times in a row. With `planes`, normals are refined.
void judge_points(VisualMap& map, const PlaneMap* planes, std::span<const SelectedPatch> patches,
                  const VisualUpdateResult& update, const PosedPicture& picture);

/// Adds points where the picture has texture and the map a plane, one at most in each cell that has no point.
/// `round` varies from picture to picture which cells come first. Returns how many were added.
int add_points(VisualMap& map, const PlaneMap& planes, const PosedPicture& picture, const PictureGrid& grid,
               const DepthCells& depths, const std::vector<bool>& occupied, std::uint32_t round);

}  // namespace edgesplat::tracking
