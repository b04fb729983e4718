// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/sensor/image.hpp"

#include <optional>

namespace edgesplat::tracking {

/// The Gaussian map as a camera without distortion would see it.
struct GaussianPicture {
  sensor::ImageRgb8 picture;
  sensor::ImageF32 depth_m;  ///< expected z in the camera frame, 0 where nothing is
  sensor::ImageF32 alpha;    ///< how much of a pixel the map fills, 0..1
};

/// Where tracking gets such pictures from: who wires the robot knows the map, tracking does not. Called
/// within Tracker::track() on its thread, and has to be done within the time of a group.
class GaussianView {
 public:
  virtual ~GaussianView() = default;
  /// Nothing where there is no map yet, or it could not be drawn.
  [[nodiscard]] virtual std::optional<GaussianPicture> draw(
      const geometry::CameraModel& camera, const geometry::RigidTransform& odom_from_camera) = 0;
};

}  // namespace edgesplat::tracking
