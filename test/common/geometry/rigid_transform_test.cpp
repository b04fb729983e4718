// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/rigid_transform.hpp"

#include "test/support/eigen_matchers.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace edgesplat::geometry {
namespace {

using test::IsNear;
using test::IsNearTransform;

TEST(RigidTransform, ProductsCompose) {
  test::Random random(1);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform c_from_b = random.transform();
    const RigidTransform b_from_a = random.transform();
    const Eigen::Vector3d p_in_a = random.vector(20.0);
    EXPECT_THAT((c_from_b * b_from_a) * p_in_a, IsNear(c_from_b * (b_from_a * p_in_a), 1e-12));
  }
}

TEST(RigidTransform, InverseUndoes) {
  test::Random random(2);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform b_from_a = random.transform();
    EXPECT_THAT(b_from_a.inverse() * b_from_a, IsNearTransform(RigidTransform{}, 1e-7, 1e-13));
  }
}

TEST(RigidTransform, MatrixRoundTrip) {
  test::Random random(3);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform before = random.transform();
    EXPECT_THAT(RigidTransform::from_matrix(before.matrix()).matrix(), IsNear(before.matrix(), 1e-14));
  }
}

TEST(RigidTransform, FromMatrixTakesTheNearestRotation) {
  test::Random random(4);
  const RigidTransform exact = random.transform();
  Eigen::Matrix<double, 3, 4> rounded = exact.matrix();
  for (int i = 0; i < 9; ++i) rounded(i % 3, i / 3) += random.uniform(-1e-5, 1e-5);
  EXPECT_THAT(RigidTransform::from_matrix(rounded), IsNearTransform(exact, 2e-5, 1e-15));
  Eigen::Matrix<double, 3, 4> mirrored = Eigen::Matrix<double, 3, 4>::Identity();
  mirrored(2, 2) = -0.1;  // determinant < 0: still a rotation comes out
  const Eigen::Matrix3d r = RigidTransform::from_matrix(mirrored).rotation.toRotationMatrix();
  EXPECT_THAT(r, IsNear(Eigen::Matrix3d::Identity(), 1e-12));
}

TEST(RigidTransform, StaysOfUnitLengthOverManyProducts) {
  test::Random random(5);
  const RigidTransform step = {so3_exp(random.vector(0.01)), random.vector(0.1)};
  RigidTransform pose;
  for (int i = 0; i < 100000; ++i) pose = pose * step;
  EXPECT_NEAR(pose.rotation.norm(), 1.0, 1e-14);
}

TEST(RigidTransform, KnowsWhatIsNotFinite) {
  RigidTransform t;
  EXPECT_TRUE(t.is_finite());
  t.translation_m.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(t.is_finite());
  t = {};
  t.rotation.w() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(t.is_finite());
}

TEST(Interpolate, MeetsItsEndsAndTurnsEvenly) {
  test::Random random(6);
  const RigidTransform first = random.transform();
  const RigidTransform second = first * RigidTransform{so3_exp({0.0, 0.0, 1.2}), {1.0, 2.0, 3.0}};
  EXPECT_THAT(interpolate(first, second, 0.0), IsNearTransform(first, 1e-7, 1e-14));
  EXPECT_THAT(interpolate(first, second, 1.0), IsNearTransform(second, 1e-7, 1e-14));
  const RigidTransform quarter = interpolate(first, second, 0.25);
  EXPECT_NEAR(quarter.rotation.angularDistance(first.rotation), 0.3, 1e-12);
  EXPECT_THAT(quarter.translation_m, IsNear(0.75 * first.translation_m + 0.25 * second.translation_m, 1e-14));
}

TEST(Interpolate, TakesTheShortWayWhateverTheQuaternionsSign) {
  const RigidTransform first;
  RigidTransform second{so3_exp({0.0, 0.4, 0.0}), Eigen::Vector3d::Zero()};
  second.rotation.coeffs() *= -1.0;
  EXPECT_NEAR(interpolate(first, second, 0.5).rotation.angularDistance(first.rotation), 0.2, 1e-12);
}

}  // namespace
}  // namespace edgesplat::geometry
