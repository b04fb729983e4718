// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"
#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/sensor/image.hpp"
#include "kernels/core/backend.hpp"

#include <memory>
#include <string>

namespace edgesplat::render {

struct View {
  sensor::ImageRgb8 picture;  ///< black where no Gaussian is
  sensor::ImageF32 depth_m;   ///< expected z in the camera frame, 0 where nothing is
  sensor::ImageF32 alpha;     ///< how much of a pixel the Gaussians fill, 0..1
};

/// Draws the Gaussians as the undistorted camera sees them, on the CPU. An empty cloud gives a black picture.
/// Errors: kInvalidArgument for a camera with distortion (see undistorted_model) or an inconsistent cloud.
[[nodiscard]] Result<View> draw_view(const gaussian::GaussianCloud& cloud,
                                     const geometry::CameraModel& camera,
                                     const geometry::RigidTransform& camera_from_map);

/// Draws a map picture after picture: on the GPU where there is one, which keeps the Gaussians until others
/// come, else on the CPU. Single-owner.
class ViewDrawer {
 public:
  /// On the fastest backend that can run here.
  ViewDrawer();
  ~ViewDrawer();
  ViewDrawer(const ViewDrawer&) = delete;
  ViewDrawer& operator=(const ViewDrawer&) = delete;

  /// As draw_view(). Where the GPU fails (its memory is full, say) the CPU draws, this picture and all after
  /// it.
  [[nodiscard]] Result<View> draw(const std::shared_ptr<const gaussian::GaussianCloud>& cloud,
                                  const geometry::CameraModel& camera,
                                  const geometry::RigidTransform& camera_from_map);
  /// What draws now.
  [[nodiscard]] core::Backend backend() const;
  /// Why the GPU was given up; empty while nothing failed.
  [[nodiscard]] const std::string& gpu_failure() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace edgesplat::render
