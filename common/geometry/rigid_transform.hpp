// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace edgesplat::geometry {

/// `b_from_a`: maps a point's coordinates from frame a to frame b, p_in_b = rotation * p_in_a +
/// translation_m. Conventions of the whole project, stated here once: frames are right-handed; quaternions
/// are written and stored in the order x, y, z, w and are of unit length; small perturbations act on the
/// right, b_from_a ⊞ (dr, dt) = (rotation Exp(dr), translation + dt); world frames have z up, bodies x
/// forward, y left, z up, cameras x right, y down, z forward. Inner names of a product match: world_from_imu
/// * imu_from_lidar.
struct RigidTransform {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();

  [[nodiscard]] static RigidTransform identity() { return {}; }
  /// From a 3x4 or 4x4 matrix [R t]; R is projected to the nearest rotation.
  [[nodiscard]] static RigidTransform from_matrix(const Eigen::Matrix<double, 3, 4>& b_from_a);
  [[nodiscard]] Eigen::Matrix<double, 3, 4> matrix() const;
  [[nodiscard]] RigidTransform inverse() const;
  [[nodiscard]] bool is_finite() const;
};

[[nodiscard]] RigidTransform operator*(const RigidTransform& c_from_b, const RigidTransform& b_from_a);
[[nodiscard]] Eigen::Vector3d operator*(const RigidTransform& b_from_a, const Eigen::Vector3d& p_in_a);

/// Between two poses of one body, t in [0, 1], or beyond: rotation along the geodesic, translation straight.
[[nodiscard]] RigidTransform interpolate(const RigidTransform& first, const RigidTransform& second, double t);

}  // namespace edgesplat::geometry
