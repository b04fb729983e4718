// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"
#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/sensor/image.hpp"

namespace edgesplat::render {

struct View {
  sensor::ImageRgb8 picture;  ///< black where no Gaussian is
  sensor::ImageF32 depth_m;   ///< expected z in the camera frame, 0 where nothing is
};

/// Draws the Gaussians as the undistorted camera sees them. An empty cloud gives a black picture.
/// Errors: kInvalidArgument for a camera with distortion (see undistorted_model) or an inconsistent cloud.
[[nodiscard]] Result<View> draw_view(const gaussian::GaussianCloud& cloud,
                                     const geometry::CameraModel& camera,
                                     const geometry::RigidTransform& camera_from_map);

}  // namespace edgesplat::render
