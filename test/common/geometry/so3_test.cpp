// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/so3.hpp"

#include "test/support/eigen_matchers.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace edgesplat::geometry {
namespace {

using test::IsNear;

/// exp(hat(v)) by its Taylor series after halving v twelve times: shares nothing with the code under test.
Eigen::Matrix3d exp_series(const Eigen::Vector3d& v) {
  const Eigen::Matrix3d x = hat(v) / 4096.0;
  Eigen::Matrix3d term = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d sum = term;
  for (int i = 1; i < 12; ++i) {
    term = term * x / i;
    sum += term;
  }
  for (int i = 0; i < 12; ++i) sum = (sum * sum).eval();
  return sum;
}

std::vector<Eigen::Vector3d> sample_vectors() {
  test::Random random(1);
  std::vector<Eigen::Vector3d> out{Eigen::Vector3d::Zero()};
  for (const double angle :
       {1e-12, 1e-9, 1e-7, 0.99e-4, 1.01e-4, 1e-2, 0.5, 1.5, 3.0, std::numbers::pi - 1e-7})
    for (int i = 0; i < 5; ++i) out.emplace_back(angle * random.direction());
  return out;
}

TEST(So3, HatIsTheCrossProduct) {
  test::Random random(2);
  const Eigen::Vector3d a = random.vector(2.0);
  const Eigen::Vector3d b = random.vector(2.0);
  EXPECT_THAT(Eigen::Vector3d(hat(a) * b), IsNear(a.cross(b), 1e-15));
}

TEST(So3, ExpAgreesWithItsSeries) {
  for (const Eigen::Vector3d& v : sample_vectors())
    EXPECT_THAT(so3_exp(v).toRotationMatrix(), IsNear(exp_series(v), 1e-11)) << v.transpose();
  const Eigen::Vector3d beyond = 10.0 * Eigen::Vector3d(0.6, 0.0, 0.8);
  EXPECT_THAT(so3_exp(beyond).toRotationMatrix(), IsNear(exp_series(beyond), 1e-10));
}

TEST(So3, LogUndoesExp) {
  for (const Eigen::Vector3d& v : sample_vectors()) {
    EXPECT_THAT(so3_log(so3_exp(v)), IsNear(v, 1e-14 + 1e-12 * v.norm())) << v.transpose();
  }
}

TEST(So3, LogTakesTheShortWay) {
  const Eigen::Vector3d v(0.0, 0.0, 1.5 * std::numbers::pi);
  EXPECT_THAT(so3_log(so3_exp(v)), IsNear(Eigen::Vector3d(0.0, 0.0, -0.5 * std::numbers::pi), 1e-14));
  const Eigen::Quaterniond q = so3_exp({0.3, -0.2, 0.1});
  const Eigen::Quaterniond minus_q(-q.w(), -q.x(), -q.y(), -q.z());
  EXPECT_THAT(so3_log(minus_q), IsNear(so3_log(q), 1e-15));
}

TEST(So3, RightJacobianIsTheDerivativeOfExp) {
  constexpr double kStep = 1e-6;
  for (const Eigen::Vector3d& v : sample_vectors()) {
    Eigen::Matrix3d numeric;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d dv = kStep * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d forward = so3_log(so3_exp(v).conjugate() * so3_exp(v + dv));
      const Eigen::Vector3d backward = so3_log(so3_exp(v).conjugate() * so3_exp(v - dv));
      numeric.col(i) = (forward - backward) / (2.0 * kStep);
    }
    EXPECT_THAT(so3_right_jacobian(v), IsNear(numeric, 1e-8)) << v.transpose();
  }
}

TEST(So3, RightJacobianInverseInverts) {
  for (const Eigen::Vector3d& v : sample_vectors()) {
    EXPECT_THAT(Eigen::Matrix3d(so3_right_jacobian_inverse(v) * so3_right_jacobian(v)),
                IsNear(Eigen::Matrix3d::Identity(), 1e-11))
        << v.transpose();
  }
}

}  // namespace
}  // namespace edgesplat::geometry
