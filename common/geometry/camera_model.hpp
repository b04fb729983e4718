// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <Eigen/Core>

#include <array>
#include <optional>

namespace edgesplat::geometry {

enum class CameraKind {
  kPinhole,  ///< radial-tangential distortion k1, k2, p1, p2 (OpenCV's first four) and k3
  kFisheye,  ///< equidistant with k1..k4 (OpenCV fisheye, Kannala-Brandt)
};

/// A calibrated camera. Camera frame: x right, y down, z forward. Pixel coordinates: the centre of the
/// top-left pixel is (0, 0), as in OpenCV and KITTI (COLMAP and nerfstudio have it at (0.5, 0.5): convert
/// where they are read).
struct CameraModel {
  CameraKind kind = CameraKind::kPinhole;
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  std::array<double, 4> distortion{};  ///< pinhole: k1 k2 p1 p2; fisheye: k1 k2 k3 k4
  double k3 = 0.0;                     ///< pinhole only; a rig's file and a keyframe on the link have none

  /// kInvalidConfig with the reason where a field makes no sense (size <= 0, focal length <= 0, not finite).
  [[nodiscard]] Status validate() const;
  /// Pixel of a point in the camera frame, also outside the picture; nothing for a point at or behind the
  /// camera (pinhole z <= 1e-6 m), for one that is not finite, or where the distortion polynomial has turned
  /// back.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_in_camera_m) const;
  /// Unit ray through a pixel: inverse of project() by Newton's method, to 1e-9 rad inside the picture.
  [[nodiscard]] Eigen::Vector3d unproject(const Eigen::Vector2d& pixel) const;
  /// True when the pixel lies in the picture with `border_px` to spare.
  [[nodiscard]] bool contains(const Eigen::Vector2d& pixel, double border_px = 0.0) const;
  [[nodiscard]] bool has_distortion() const { return k3 != 0.0 || distortion != decltype(distortion){}; }
  /// The same camera for a picture scaled by `factor` (size rounded, intrinsics exact for the rounded size).
  [[nodiscard]] CameraModel scaled(double factor) const;
  [[nodiscard]] CameraModel scaled_to(int to_width_px, int to_height_px) const;
  bool operator==(const CameraModel&) const = default;
};

}  // namespace edgesplat::geometry
