// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/plane_sums.hpp"

#include <cstddef>

namespace edgesplat::tracking {

void PlaneSums::add(const MatchedPoint& line, const Eigen::Vector3f& p_in_body_m,
                    const Eigen::Matrix3f& odom_from_body_rotation, float weight) {
  const Eigen::Matrix<float, 6, 1> weighted = weight * line.row;
  std::size_t at = 0;
  for (int i = 0; i < 6; ++i)
    for (int k = i; k < 6; ++k) information_[at++] += weighted(i) * line.row(k);
  gradient_ += line.residual_m * weighted;
  add_noise(*line.plane, p_in_body_m, odom_from_body_rotation, weight);
  ++used_;
  squares_m2_ += static_cast<double>(line.residual_m) * static_cast<double>(line.residual_m);
}

/// The covariance of the row, the normal being uncertain: it is linear in the normal, (hat(p) R', I) n.
void PlaneSums::add_noise(const Plane& plane, const Eigen::Vector3f& p, const Eigen::Matrix3f& rotation,
                          float weight) {
  const Symmetric3f& c = plane.normal_covariance;
  std::array<Eigen::Vector3f, 3> lever;  // rows of hat(p) R'
  std::array<Eigen::Vector3f, 3> moved;  // of the weighted product with the normal's covariance
  lever[0] = p.y() * rotation.col(2) - p.z() * rotation.col(1);
  lever[1] = p.z() * rotation.col(0) - p.x() * rotation.col(2);
  lever[2] = p.x() * rotation.col(1) - p.y() * rotation.col(0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3f& l = lever[i];
    moved[i] = weight * Eigen::Vector3f(l.x() * c(0) + l.y() * c(1) + l.z() * c(2),
                                        l.x() * c(1) + l.y() * c(3) + l.z() * c(4),
                                        l.x() * c(2) + l.y() * c(4) + l.z() * c(5));
  }
  std::size_t at = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = i; k < 3; ++k) noise_[at++] += moved[i].dot(lever[k]);
    for (int k = 0; k < 3; ++k) noise_[at++] += moved[i](k);
  }
  for (int k = 0; k < 6; ++k) noise_[at++] += weight * c(k);
}

Matrix6d PlaneSums::widened(const Triangle& upper) {
  Matrix6d full;
  std::size_t at = 0;
  for (int i = 0; i < 6; ++i)
    for (int k = i; k < 6; ++k) full(i, k) = full(k, i) = static_cast<double>(upper[at++]);
  return full;
}

PlaneResiduals PlaneSums::total(int matched) const {
  return {{widened(information_), gradient_.cast<double>(), widened(noise_)}, used_, matched, squares_m2_};
}

}  // namespace edgesplat::tracking
