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

struct StartOptions {
  double extent = 1.0;        ///< of the scene (camera_extent())
  std::size_t most = 40'000;  ///< Gaussians, evenly taken among the points
  float opacity = 0.1F;       ///< 3DGS's; 0.01..0.9
};
/// A Gaussian a point: round, as wide as its three nearest neighbours are far. Points without colour are
/// grey.
[[nodiscard]] gaussian::GaussianCloud gaussians_of_points(const io::PointCloud& points,
                                                          const StartOptions& options,
                                                          mapping::IdAllocator& ids);

}  // namespace edgesplat::desk
