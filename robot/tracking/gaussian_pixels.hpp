// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/image/gray_pyramid.hpp"
#include "robot/tracking/degeneracy.hpp"
#include "robot/tracking/depth_cells.hpp"
#include "robot/tracking/gaussian_view.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace edgesplat::tracking {

/// Sizes at which a picture is held against the map: as drawn, halved, halved again.
inline constexpr int kGaussianLevels = 3;

/// A pixel of the drawn map that tells about the pose.
struct GaussianPixel {
  Eigen::Vector3f p_in_camera_m;             ///< what is seen there, from where it was drawn
  float value;                               ///< grey levels of 255
  Eigen::Matrix<float, 6, 1> value_by_pose;  ///< how the pixel of a picture taken from elsewhere would change
};

/// A place on a surface of the drawn map that a point of the scan should lie on.
struct SurfacePoint {
  Eigen::Vector3f p_in_body_m;  ///< the scan's
  Eigen::Vector3d on_surface_in_odom_m;
  Eigen::Vector3d normal_in_odom;
};

/// Where a picture of the map was drawn from.
struct DrawnFrom {
  geometry::CameraModel camera;  ///< without distortion
  geometry::RigidTransform odom_from_body;
  geometry::RigidTransform body_from_camera;
};

/// What a drawn picture of the map offers to hold on to.
struct GaussianPixels {
  std::array<std::vector<GaussianPixel>, kGaussianLevels> levels;  ///< finest first
  std::vector<SurfacePoint> surface;
  double coverage = 0.0;  ///< share of the picture that the map fills
};

/// Chooses them: where the map fills the picture, is no edge in depth, has texture, and the scan does not
/// speak against its depth (what moves, what is not there any more). `depths`: the scan from the same place,
/// in pixels of the drawn picture. Deterministic. Keeps its memory.
class GaussianPixelChooser {
 public:
  void choose(const GaussianPicture& drawn, const DrawnFrom& from, const DepthCells& depths,
              std::span<const Eigen::Vector3f> scan_in_body_m, GaussianPixels& out);

 private:
  void choose_level(int level, const DrawnFrom& from, const DepthCells& depths,
                    std::vector<GaussianPixel>& out) const;
  void halve_depth(int level);

  image::GrayPyramid gray_;
  std::array<sensor::ImageF32, kGaussianLevels> depth_m_;  ///< 0 where it does not count
};

/// d value / d (rotation of the body, its position in odom) of a picture taken from a pose, where the map's
/// brightness has the slope `slope` (grey levels a pixel) at a point.
[[nodiscard]] Eigen::Matrix<float, 6, 1> value_by_pose(const Eigen::Vector3f& p_in_camera_m,
                                                       const Eigen::Vector2f& slope, const DrawnFrom& from);

}  // namespace edgesplat::tracking
