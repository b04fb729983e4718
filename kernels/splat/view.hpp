// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"

#include <array>

namespace edgesplat::splat {

/// From where and how a picture is drawn: a pinhole or an equidistant fisheye without distortion, in single
/// precision for the kernels. Pixel centres lie at integer coordinates (camera_model.hpp).
struct View {
  int width_px = 0;
  int height_px = 0;
  bool fisheye = false;  ///< then depths are distances from the camera
  float fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
  std::array<float, 9> rotation{};     ///< camera_from_map, row-major
  std::array<float, 3> translation{};  ///< camera_from_map, m
  std::array<float, 3> position{};     ///< of the camera in map, m

  /// kInvalidArgument for a distorted camera, a senseless one, or a pose that is not finite.
  static Result<View> from(const geometry::CameraModel& camera,
                           const geometry::RigidTransform& camera_from_map);
};

/// Conventions of the blend; the defaults are those of 3D Gaussian Splatting (Kerbl 2023).
struct RenderOptions {
  float near_m = 0.05F;       ///< nearer Gaussians are not drawn, > 0
  float low_pass_px2 = 0.3F;  ///< added to the projected covariance so that a splat covers a pixel, >= 0
  /// What the low-pass spreads it also makes fainter (Yu 2024, Mip-Splatting): maps look the same from
  /// further away. For maps that were trained so.
  bool antialiased = false;
  /// Of Gaussians whose longest axis (1 sigma) is smaller than this on the screen only some are drawn, as
  /// large as this, so that they cover what all would (thin_math.hpp); for pictures of maps from far away.
  /// 0: all are drawn, >= 0. Not for training: the reverse does not know it.
  float least_axis_px = 0.0F;
  std::array<float, 3> background{};
};

}  // namespace edgesplat::splat
