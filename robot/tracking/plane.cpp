// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/plane.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace edgesplat::tracking {
namespace {

/// Below this ratio of the middle to the smallest eigenvalue, the points are a line and the normal is noise.
constexpr double kLineRatio = 8.0;

}  // namespace

void PointSums::add(const Eigen::Vector3f& p, const Symmetric3f& covariance_m2,
                    const Symmetric3f& pose_covariance_m2) {
  ++count;
  sum_m += p;
  squares_m2(0) += p.x() * p.x();
  squares_m2(1) += p.x() * p.y();
  squares_m2(2) += p.x() * p.z();
  squares_m2(3) += p.y() * p.y();
  squares_m2(4) += p.y() * p.z();
  squares_m2(5) += p.z() * p.z();
  noise_m2 += covariance_m2;
  pose_m2 += pose_covariance_m2;
}

// With eigenvalues l0 <= l1 <= l2 and axes u0 = n, u1, u2 of the scatter C = 1/N sum d_i d_i', a small shift
// e_i of point i turns the normal by u_m d_i' (u_m n' + n u_m') e_i / (N (l0 - l_m)) for m = 1, 2 and moves
// the centre by e_i / N (VoxelMap, eq. 6). Let every e_i have the mean covariance S, in the axes of C.
// Summing over i replaces sum d_i d_i' by N C, which is diagonal here:
//   Cov(a_m, a_k) = (l0 S_mk + [m = k] l_m S_00) / (N (l0 - l_m)(l0 - l_k)),  Var(n' centre) = S_00 / N,
// and the two are uncorrelated because sum d_i = 0.
PlaneFit fit_plane(const PointSums& sums, float sigma_max_m) {
  PlaneFit fit;
  if (sums.count < 4) return fit;
  const double n = sums.count;
  const Eigen::Vector3d mean = sums.sum_m.cast<double>() / n;
  const Eigen::Matrix3d scatter = unpack(sums.squares_m2).cast<double>() / n - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(scatter);
  const Eigen::Vector3d lambda = solver.eigenvalues().cwiseMax(1e-9);
  if (!(lambda(0) < static_cast<double>(sigma_max_m) * static_cast<double>(sigma_max_m))) return fit;
  if (lambda(1) < kLineRatio * lambda(0)) {
    fit.verdict = PlaneVerdict::kUndecided;
    return fit;
  }
  const Eigen::Matrix3d& axes = solver.eigenvectors();
  Eigen::Matrix3d noise = axes.transpose() * (unpack(sums.noise_m2).cast<double>() / n) * axes;
  const double excess = std::max(0.0, lambda(0) - noise(0, 0));
  noise(0, 0) += excess;  // roughness moves the fit as noise does
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Zero();
  for (int m = 1; m < 3; ++m) {
    for (int k = 1; k < 3; ++k) {
      const double numerator = lambda(0) * noise(m, k) + (m == k ? lambda(m) * noise(0, 0) : 0.0);
      const double covariance = numerator / (n * (lambda(0) - lambda(m)) * (lambda(0) - lambda(k)));
      normal_covariance += covariance * axes.col(m) * axes.col(k).transpose();
    }
  }
  fit.verdict = PlaneVerdict::kPlane;
  fit.plane.normal = axes.col(0).cast<float>();
  fit.plane.centre_m = mean.cast<float>();
  fit.plane.normal_covariance = pack(normal_covariance.cast<float>());
  const double pose_variance = axes.col(0).dot(unpack(sums.pose_m2).cast<double>() * axes.col(0)) / n;
  fit.plane.offset_variance_m2 = static_cast<float>(noise(0, 0) / n + pose_variance);
  fit.plane.excess_variance_m2 = static_cast<float>(excess);
  fit.plane.reach_m2 = static_cast<float>(lambda(2));
  return fit;
}

}  // namespace edgesplat::tracking
