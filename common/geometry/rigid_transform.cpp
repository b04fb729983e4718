// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/rigid_transform.hpp"

#include "common/geometry/so3.hpp"

#include <Eigen/SVD>

namespace edgesplat::geometry {

RigidTransform RigidTransform::from_matrix(const Eigen::Matrix<double, 3, 4>& b_from_a) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(b_from_a.leftCols<3>(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) *= -1.0;
  return {Eigen::Quaterniond(u * svd.matrixV().transpose()).normalized(), b_from_a.col(3)};
}

Eigen::Matrix<double, 3, 4> RigidTransform::matrix() const {
  Eigen::Matrix<double, 3, 4> m;
  m.leftCols<3>() = rotation.toRotationMatrix();
  m.col(3) = translation_m;
  return m;
}

RigidTransform RigidTransform::inverse() const {
  const Eigen::Quaterniond a_from_b = rotation.conjugate();
  return {a_from_b, -(a_from_b * translation_m)};
}

bool RigidTransform::is_finite() const {
  return rotation.coeffs().allFinite() && translation_m.allFinite();
}

RigidTransform operator*(const RigidTransform& c_from_b, const RigidTransform& b_from_a) {
  return {(c_from_b.rotation * b_from_a.rotation).normalized(),
          c_from_b.rotation * b_from_a.translation_m + c_from_b.translation_m};
}

Eigen::Vector3d operator*(const RigidTransform& b_from_a, const Eigen::Vector3d& p_in_a) {
  return b_from_a.rotation * p_in_a + b_from_a.translation_m;
}

RigidTransform interpolate(const RigidTransform& first, const RigidTransform& second, double t) {
  const Eigen::Vector3d turn = so3_log(first.rotation.conjugate() * second.rotation);
  return {(first.rotation * so3_exp(t * turn)).normalized(),
          first.translation_m + t * (second.translation_m - first.translation_m)};
}

}  // namespace edgesplat::geometry
