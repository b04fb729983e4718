// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/calibration.hpp"

#include "common/geometry/so3.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;

const Vector3d kTurn_radps(0.2, -0.1, 0.8);  // in the body
const Vector3d kSpeed_mps(1.2, 0.1, -0.2);   // in the body

HostTime at(double t) {
  return HostTime(from_seconds(50.0 + t));
}

/// A screw: constant turn and speed in the body, integrated finely.
geometry::RigidTransform screw(double t) {
  geometry::RigidTransform pose{geometry::so3_exp({0.3, 0.2, -1.0}), {4.0, -3.0, 1.0}};
  constexpr int kSteps = 4000;
  for (int i = 0; i < kSteps; ++i) {
    const double dt = t / kSteps;
    pose.translation_m += dt * (pose.rotation * geometry::so3_exp(0.5 * dt * kTurn_radps) * kSpeed_mps);
    pose.rotation = pose.rotation * geometry::so3_exp(dt * kTurn_radps);
  }
  return pose;
}

std::vector<PathKnot> screw_path(double begin_s, double end_s) {
  std::vector<PathKnot> path;
  for (double t = begin_s; t < end_s + 1e-9; t += 0.005) path.push_back({at(t), screw(t)});
  return path;
}

TEST(TwistAtEnd, IsThatOfAScrewHoweverLongTheSpan) {
  const auto path = screw_path(0.0, 0.1);
  for (const double span_s : {0.01, 0.02, 0.1}) {
    const BodyTwist twist = twist_at_end(path, from_seconds(span_s));
    EXPECT_LT((twist.turn_in_body_radps - kTurn_radps).norm(), 1e-6) << span_s;
    EXPECT_LT((twist.step_in_odom_mps - screw(0.1).rotation * kSpeed_mps).norm(), 3e-3) << span_s;
  }
  EXPECT_TRUE(twist_at_end({path.front()}, from_seconds(0.1)).turn_in_body_radps.isZero());
}

TEST(Moved, GoesOnAlongTheScrew) {
  const BodyTwist twist = twist_at_end(screw_path(0.0, 0.1), from_seconds(0.02));
  for (const double later_s : {-0.01, 0.01}) {
    const auto pose = moved(screw(0.1), twist, later_s);
    const auto truth = screw(0.1 + later_s);
    EXPECT_LT(geometry::so3_log(pose.rotation.conjugate() * truth.rotation).norm(), 1e-5);
    EXPECT_LT((pose.translation_m - truth.translation_m).norm(), 1e-4);  // half an acceleration: 0.05 mm
  }
}

TEST(Lengthen, ReachesBeforeAndBehindThePath) {
  auto path = screw_path(0.0, 0.1);
  const std::size_t knots = path.size();
  lengthen(path, from_seconds(0.008));
  ASSERT_EQ(path.size(), knots + 2);
  EXPECT_EQ(path.front().stamp, at(0.0) - from_seconds(0.008));
  EXPECT_LT((path.front().odom_from_body.translation_m - screw(-0.008).translation_m).norm(), 1e-4);
  EXPECT_LT((path.back().odom_from_body.translation_m - screw(0.108).translation_m).norm(), 1e-4);
  lengthen(path, nanoseconds(0));
  EXPECT_EQ(path.size(), knots + 2);
}

/// Every column against what its error does to points: p_odom = T(t + delay) body_from_lidar p_lidar.
TEST(ScanByCalibration, AgreesWithNumericDifferences) {
  test::Random random(3);
  FilterState state;
  state.odom_from_body = screw(0.1);
  state.calibration.body_from_lidar = {random.rotation(), {0.1, -0.2, 0.3}};
  const BodyTwist twist = twist_at_end(screw_path(0.0, 0.1), from_seconds(0.02));
  const PoseByCalibration by = scan_by_calibration(state, twist);
  constexpr double kStep = 1e-5;
  const auto see = [&](const FilterState& with, const Vector3d& p_in_lidar) -> Vector3d {
    return moved(with.odom_from_body, twist, with.calibration.lidar_delay_s) *
           (with.calibration.body_from_lidar * p_in_lidar);
  };
  for (int k = 0; k < kCalibrationErrors; ++k) {
    FilterState nudged = state;
    nudged.calibration = plus(state.calibration, kStep * CalibrationVector::Unit(k));
    ErrorVector as_pose = ErrorVector::Zero();
    as_pose.head<6>() = kStep * by.col(k);
    for (int n = 0; n < 5; ++n) {
      const Vector3d p = random.vector(10.0);
      const Vector3d expected = (see(nudged, p) - see(state, p)) / kStep;
      const Vector3d found = (see(plus(state, as_pose), p) - see(state, p)) / kStep;
      EXPECT_LT((expected - found).norm(), 1e-3) << "column " << k;
    }
  }
}

TEST(CalibrationView, PoseWithShowsWhatTheCalibrationWould) {
  test::Random random(4);
  FilterState state;
  state.odom_from_body = screw(0.1);
  state.calibration.body_from_lidar = {random.rotation(), {0.1, -0.2, 0.3}};
  const SensorCalibration used = state.calibration;
  CalibrationView view;
  view.twist = twist_at_end(screw_path(0.0, 0.1), from_seconds(0.02));
  view.by_calibration = scan_by_calibration(state, view.twist);
  CalibrationVector change = CalibrationVector::Zero();
  change(kLidarDelay) = 0.004;
  change.segment<3>(kLidarTurn) << 0.004, -0.003, 0.002;
  change.segment<3>(kLidarStep) << 0.01, 0.02, -0.01;
  state.calibration = plus(state.calibration, change);
  const geometry::RigidTransform pose = view.pose_with(used, state);
  const Vector3d p(5.0, -2.0, 1.0);
  const Vector3d truth =
      moved(state.odom_from_body, view.twist, 0.004) * (state.calibration.body_from_lidar * p);
  EXPECT_LT((pose * (used.body_from_lidar * p) - truth).norm(), 3e-4);
  EXPECT_TRUE(
      view.pose_with(state.calibration, state).matrix().isApprox(state.odom_from_body.matrix(), 1e-12));
}

}  // namespace
}  // namespace edgesplat::tracking
