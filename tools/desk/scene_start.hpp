// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"
#include "common/io/ply_points.hpp"
#include "kernels/mapping/id_allocator.hpp"
#include "tools/desk/scene.hpp"

#include <span>

namespace edgesplat::desk {

/// Points of a scene from its pictures alone: SIFT features of neighbouring pictures that agree with the
/// known poses (epipolar distance, reprojection, at least 1.5 degrees between the rays). Deterministic. Empty
/// where nothing agrees; kIo where OpenCV fails.
[[nodiscard]] Result<io::PointCloud> triangulate(std::span<const ScenePicture* const> pictures);

/// A Gaussian a point: round, as wide as its three nearest neighbours are far, opacity 0.1 (3DGS). Points
/// without colour are grey; `extent` is the scene's (camera_extent()). At most `most` of them, evenly taken.
[[nodiscard]] gaussian::GaussianCloud gaussians_of_points(const io::PointCloud& points, double extent,
                                                          std::size_t most, mapping::IdAllocator& ids);

}  // namespace edgesplat::desk
