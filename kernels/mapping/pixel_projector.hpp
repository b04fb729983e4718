// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"

#include <Eigen/Core>

#include <optional>

namespace edgesplat::mapping {

/// Into which pixel of an undistorted picture points fall, in single precision for loops over many.
/// Immutable.
class PixelProjector {
 public:
  struct Hit {
    int x, y;       ///< the pixel whose centre is nearest
    float depth_m;  ///< z in the camera frame
  };

  PixelProjector(const geometry::RigidTransform& camera_from_points, const geometry::CameraModel& pinhole)
      : rotation_(camera_from_points.rotation.toRotationMatrix().cast<float>()),
        translation_(camera_from_points.translation_m.cast<float>()),
        fx_(static_cast<float>(pinhole.fx_px)),
        fy_(static_cast<float>(pinhole.fy_px)),
        cx_(static_cast<float>(pinhole.cx_px)),
        cy_(static_cast<float>(pinhole.cy_px)),
        width_(static_cast<float>(pinhole.width_px)),
        height_(static_cast<float>(pinhole.height_px)) {}

  /// Nothing for a point nearer than `nearest_m`, outside the picture or not finite.
  [[nodiscard]] std::optional<Hit> project(const Eigen::Vector3f& point_m, float nearest_m) const {
    const Eigen::Vector3f p = rotation_ * point_m + translation_;
    if (!(p.z() > nearest_m)) return std::nullopt;
    const float u = fx_ * p.x() / p.z() + cx_ + 0.5F;  // pixel centres lie at whole numbers
    const float v = fy_ * p.y() / p.z() + cy_ + 0.5F;
    if (!(u >= 0.0F && v >= 0.0F && u < width_ && v < height_)) return std::nullopt;
    return Hit{static_cast<int>(u), static_cast<int>(v), p.z()};
  }

 private:
  Eigen::Matrix3f rotation_;
  Eigen::Vector3f translation_;
  float fx_, fy_, cx_, cy_;
  float width_, height_;
};

}  // namespace edgesplat::mapping
