// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/degeneracy.hpp"

#include "test/support/random.hpp"

#include <gtest/gtest.h>

namespace edgesplat::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kWeight = 1e4;     // residuals of 1 cm
constexpr double kTilt_rad = 0.01;  // of each normal, by chance

/// Rows of points on planes whose normals are `normals` in turn, each tilted by chance; the body is at odom.
NormalEquations equations_of(const std::vector<Vector3d>& normals, double turn_unit = 1.0) {
  test::Random random(4);
  NormalEquations sums;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d truth = normals[static_cast<std::size_t>(i) % normals.size()];
    const Vector3d tilt = kTilt_rad * Vector3d(random.normal(), random.normal(), random.normal());
    const Vector3d normal = truth + tilt - truth * truth.dot(tilt);
    const Matrix3d covariance = kTilt_rad * kTilt_rad * (Matrix3d::Identity() - truth * truth.transpose());
    const Vector3d p = random.vector(5.0);
    Matrix3d lever;
    lever << 0, -p.z(), p.y(), p.z(), 0, -p.x(), -p.y(), p.x(), 0;
    Eigen::Matrix<double, 6, 3> row_of_normal;
    row_of_normal << turn_unit * lever, Matrix3d::Identity();
    const Vector6d row = row_of_normal * normal;
    sums.information += kWeight * row * row.transpose();
    sums.gradient += kWeight * 0.01 * random.normal() * row;
    sums.noise += kWeight * row_of_normal * covariance * row_of_normal.transpose();
  }
  return sums;
}

const std::vector<Vector3d> kRoom = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};

TEST(KeepObserved, ARoomIsSeenInEveryDirection) {
  const NormalEquations room = equations_of(kRoom);
  const ObservedPart part = keep_observed(room);
  EXPECT_EQ(part.frozen, 0);
  EXPECT_GT(part.weakest.signal, 100.0);
  EXPECT_LT((part.information - room.information).norm(), 0.02 * room.information.norm());
  EXPECT_LT((part.gradient - room.gradient).norm(), 0.02 * room.gradient.norm());
}

TEST(KeepObserved, AStraightTunnelIsNotSeenAlong) {
  std::vector<Vector3d> walls;
  const Vector3d along = Vector3d(1.0, 0.3, 0.1).normalized();
  const Vector3d side = along.unitOrthogonal();
  for (int i = 0; i < 12; ++i) {
    const double angle = 0.5 * i;
    walls.push_back(std::cos(angle) * side + std::sin(angle) * along.cross(side));
  }
  const NormalEquations tunnel = equations_of(walls);
  // Chance alone pretends to see the step along to 2 mm a scan.
  EXPECT_GT(along.dot(tunnel.information.block<3, 3>(3, 3) * along), 1.0 / (0.02 * 0.02));
  const ObservedPart part = keep_observed(tunnel);
  ASSERT_EQ(part.frozen, 1);
  EXPECT_NEAR(part.weakest.signal, 1.0, 0.3);
  EXPECT_NEAR(std::abs(part.weakest.step_in_odom.dot(along)), 1.0, 1e-3);
  EXPECT_LT((part.frozen_steps - along * along.transpose()).norm(), 0.03);
  EXPECT_EQ(part.frozen_turns, Matrix3d::Zero());
}

TEST(KeepObserved, AFloorLeavesTwoStepsAndATurn) {
  const ObservedPart part = keep_observed(equations_of({Vector3d::UnitZ()}));
  ASSERT_EQ(part.frozen, 3);
  const Matrix3d level = Vector3d(1, 1, 0).asDiagonal();
  EXPECT_LT((part.frozen_steps - level).norm(), 0.05);
  EXPECT_LT((part.frozen_turns - Matrix3d(Vector3d(0, 0, 1).asDiagonal())).norm(), 0.05);
}

TEST(KeepObserved, TheUnitOfTurnsDoesNotMatter) {
  const ObservedPart radians = keep_observed(equations_of({Vector3d::UnitZ(), Vector3d::UnitY()}));
  const ObservedPart milliradians = keep_observed(equations_of({Vector3d::UnitZ(), Vector3d::UnitY()}, 1e-3));
  EXPECT_NEAR(radians.weakest.signal / milliradians.weakest.signal, 1.0, 1e-3);
  EXPECT_EQ(radians.frozen, milliradians.frozen);
}

TEST(KeepObserved, NothingAtAllIsFrozenWhole) {
  const ObservedPart part = keep_observed(NormalEquations{});
  EXPECT_EQ(part.frozen, 6);
  EXPECT_EQ(part.information, Matrix6d::Zero());
}

}  // namespace
}  // namespace edgesplat::tracking
