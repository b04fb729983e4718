// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/sensor/image.hpp"

#include <vector>

namespace edgesplat::test {

/// A map trained on pictures taken along the simulated corridor.
struct FinishedMap {
  gaussian::GaussianCloud cloud;
  geometry::CameraModel camera;
  std::vector<geometry::RigidTransform> map_from_body;  ///< of keyframes 0, 1, 2...; the camera looks along x
  std::vector<sensor::ImageRgb8> pictures;              ///< theirs, without movers

  /// Mean PSNR of `drawn`, seen from `poses`, against the pictures.
  [[nodiscard]] double psnr_db(const gaussian::GaussianCloud& drawn,
                               const std::vector<geometry::RigidTransform>& poses) const;
};

/// `steps` optimisation steps on eight keyframes 0.6 m apart. The colours may depend strongly on direction.
[[nodiscard]] FinishedMap train_corridor(int sh_degree, int steps);

}  // namespace edgesplat::test
