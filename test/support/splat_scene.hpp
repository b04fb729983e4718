// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/geometry/camera_model.hpp"

#include <cstddef>
#include <cstdint>

namespace edgesplat::test {

/// What every timing of the kernels is taken on, whatever the backend.
struct SplatSceneShape {
  std::size_t count = 10000;
  int width_px = 320, height_px = 256;
  int sh_degree = 0;
  int share =
      1;  ///< one Gaussian in so many is in view, the others lie to the sides of the camera and behind it
  std::uint64_t seed = 1;
};

/// Camera at the origin of the map, looking along z.
struct SplatScene {
  geometry::CameraModel camera;
  gaussian::GaussianCloud cloud;
};

/// Gaussians 1 to 10 m away, anywhere in the picture, turned anyhow: projected sigma (the geometric mean of
/// the ellipse's two) 2 px in the median, axes of 0.3 to 1 of the longest, opacities 0.05 to 0.95.
[[nodiscard]] SplatScene splat_scene(const SplatSceneShape& shape);

}  // namespace edgesplat::test
