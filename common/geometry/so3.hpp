// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace edgesplat::geometry {

/// [v]x, so that hat(a) * b == a.cross(b).
[[nodiscard]] Eigen::Matrix3d hat(const Eigen::Vector3d& v);
/// Exponential map: rotation vector (rad) to unit quaternion; exact to rounding for any length, 0 included.
[[nodiscard]] Eigen::Quaterniond so3_exp(const Eigen::Vector3d& rotation_vector_rad);
/// Logarithm, length in [0, pi].
[[nodiscard]] Eigen::Vector3d so3_log(const Eigen::Quaterniond& rotation);
/// Jr with Exp(v + dv) = Exp(v) Exp(Jr(v) dv) to first order (Sola 2018, eq. 143).
[[nodiscard]] Eigen::Matrix3d so3_right_jacobian(const Eigen::Vector3d& rotation_vector_rad);
/// Jr(v)^-1 (Sola 2018, eq. 144); |v| < 2 pi.
[[nodiscard]] Eigen::Matrix3d so3_right_jacobian_inverse(const Eigen::Vector3d& rotation_vector_rad);

}  // namespace edgesplat::geometry
