// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/plane_sums.hpp"

#include "common/geometry/so3.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

namespace edgesplat::tracking {
namespace {

/// Against whole matrices in 64 bits, for points on planes of any slant and uncertainty.
TEST(PlaneSums, AreThoseOfWholeMatrices) {
  test::Random random(11);
  const Eigen::Matrix3d rotation = geometry::so3_exp(random.vector(1.0)).toRotationMatrix();
  PlaneSums sums;
  Matrix6d information = Matrix6d::Zero(), noise = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double squares_m2 = 0.0;
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d p = random.vector(8.0), normal = random.direction();
    Eigen::Matrix3d root;
    root << random.vector(0.03), random.vector(0.03), random.vector(0.03);
    Plane plane{};
    plane.normal = normal.cast<float>();
    plane.normal_covariance = pack((root * root.transpose()).cast<float>());
    MatchedPoint line;
    line.plane = &plane;
    line.residual_m = static_cast<float>(random.uniform(-0.1, 0.1));
    line.row << p.cross(rotation.transpose() * normal).cast<float>(), normal.cast<float>();
    const double weight = random.uniform(100.0, 2000.0);
    sums.add(line, p.cast<float>(), rotation.cast<float>(), static_cast<float>(weight));

    const Vector6d row = line.row.cast<double>();
    information += weight * row * row.transpose();
    gradient += weight * static_cast<double>(line.residual_m) * row;
    squares_m2 += static_cast<double>(line.residual_m) * static_cast<double>(line.residual_m);
    Eigen::Matrix<double, 6, 3> by_normal;
    by_normal << geometry::hat(p) * rotation.transpose(), Eigen::Matrix3d::Identity();
    noise += weight * by_normal * root * root.transpose() * by_normal.transpose();
  }
  const PlaneResiduals total = sums.total(60);
  EXPECT_EQ(total.used, 50);
  EXPECT_EQ(total.matched, 60);
  EXPECT_NEAR(total.squares_m2, squares_m2, 1e-9);
  EXPECT_LT((total.equations.information - information).norm(), 1e-5 * information.norm());
  EXPECT_LT((total.equations.gradient - gradient).norm(), 1e-4 * gradient.norm());
  EXPECT_LT((total.equations.noise - noise).norm(), 1e-5 * noise.norm());
  EXPECT_EQ(total.equations.noise, total.equations.noise.transpose());
}

}  // namespace
}  // namespace edgesplat::tracking
