// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace edgesplat::test {

struct ReferenceOptions {
  double near_m = 0.05;
  double low_pass_px2 = 0.3;
  bool antialiased = false;
  double least_axis_px = 0.0;
  Eigen::Vector3d background = Eigen::Vector3d::Zero();
};

/// A cloud in double precision, so that differences between neighbouring ones can be taken.
struct ReferenceCloud {
  ReferenceCloud(const gaussian::GaussianCloud& cloud);
  int sh_degree;
  std::vector<double> means_m, log_scales, quats_xyzw, opacity_logits, sh;
  [[nodiscard]] std::size_t size() const { return opacity_logits.size(); }
};

/// One Gaussian on the screen.
struct ReferenceSplat {
  Eigen::Vector2d centre_px;
  Eigen::Matrix2d covariance_px2;
  Eigen::Vector3d rgb;
  double opacity;
  double depth_m;
  std::size_t row;
};

struct ReferencePicture {
  std::vector<Eigen::Vector3d> colour;  ///< [H*W]
  std::vector<double> depth_sum_m;      ///< [H*W]
  std::vector<double> alpha;            ///< [H*W]
};

/// What 3D Gaussian Splatting draws, written down as plainly as can be: double precision, each pixel over all
/// Gaussians, no tiles, no bounding boxes, no shared code with kernels/splat. Finite clouds only.
[[nodiscard]] std::vector<ReferenceSplat> reference_splats(const ReferenceCloud& cloud,
                                                           const geometry::CameraModel& camera,
                                                           const geometry::RigidTransform& camera_from_map,
                                                           const ReferenceOptions& options);
[[nodiscard]] ReferencePicture reference_render(const ReferenceCloud& cloud,
                                                const geometry::CameraModel& camera,
                                                const geometry::RigidTransform& camera_from_map,
                                                const ReferenceOptions& options);

}  // namespace edgesplat::test
