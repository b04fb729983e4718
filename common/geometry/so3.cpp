// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/so3.hpp"

#include <cmath>

namespace edgesplat::geometry {

Eigen::Matrix3d hat(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Quaterniond so3_exp(const Eigen::Vector3d& rotation_vector_rad) {
  const double angle = rotation_vector_rad.norm();
  // sin(x/2)/x by its series below 1e-4: the next term is under 1e-18.
  const double factor = angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  const Eigen::Vector3d v = factor * rotation_vector_rad;
  return Eigen::Quaterniond(std::cos(0.5 * angle), v.x(), v.y(), v.z()).normalized();
}

Eigen::Vector3d so3_log(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0 ? -1.0 : 1.0;  // q and -q are one rotation: take the short way
  const Eigen::Vector3d v = sign * rotation.vec();
  const double sine = v.norm();
  const double cosine = sign * rotation.w();
  if (sine < 1e-9) return 2.0 * v;
  return (2.0 * std::atan2(sine, cosine) / sine) * v;
}

Eigen::Matrix3d so3_right_jacobian(const Eigen::Vector3d& rotation_vector_rad) {
  const double angle = rotation_vector_rad.norm();
  const Eigen::Matrix3d h = hat(rotation_vector_rad);
  if (angle < 1e-4) return Eigen::Matrix3d::Identity() - 0.5 * h + (1.0 / 6.0) * h * h;
  const double a2 = angle * angle;
  return Eigen::Matrix3d::Identity() - ((1.0 - std::cos(angle)) / a2) * h +
         ((angle - std::sin(angle)) / (a2 * angle)) * h * h;
}

Eigen::Matrix3d so3_right_jacobian_inverse(const Eigen::Vector3d& rotation_vector_rad) {
  const double angle = rotation_vector_rad.norm();
  const Eigen::Matrix3d h = hat(rotation_vector_rad);
  if (angle < 1e-4) return Eigen::Matrix3d::Identity() + 0.5 * h + (1.0 / 12.0) * h * h;
  const double half = 0.5 * angle;
  return Eigen::Matrix3d::Identity() + 0.5 * h + ((1.0 - half / std::tan(half)) / (angle * angle)) * h * h;
}

}  // namespace edgesplat::geometry
