// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/propagation.hpp"

#include "common/geometry/so3.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;

FilterState some_state(test::Random& random) {
  FilterState state;
  state.odom_from_body = random.transform();
  state.velocity_in_odom_mps = random.vector(3.0);
  state.gyro_bias_radps = random.vector(0.1);
  state.accel_bias_mps2 = random.vector(0.5);
  return state;
}

TEST(FilterState, MinusUndoesPlus) {
  test::Random random(1);
  const FilterState state = some_state(random);
  ErrorVector error;
  for (int i = 0; i < kErrorSize; ++i) error(i) = random.uniform(-0.5, 0.5);
  EXPECT_TRUE(minus(plus(state, error), state).isApprox(error, 1e-9));
}

TEST(Propagation, TransitionAgreesWithNumericDifferences) {
  test::Random random(2);
  const FilterState state = some_state(random);
  const MotionInput input{random.vector(3.0), random.vector(12.0)};
  const double dt_s = 0.01;
  const ErrorMatrix analytic = transition(state, input, dt_s);
  const FilterState next = integrate(state, input, dt_s);
  constexpr double kStep = 1e-5;
  for (int i = 0; i < kErrorSize; ++i) {
    const ErrorVector nudge = kStep * ErrorVector::Unit(i);
    const ErrorVector numeric = (minus(integrate(plus(state, nudge), input, dt_s), next) -
                                 minus(integrate(plus(state, -nudge), input, dt_s), next)) /
                                (2.0 * kStep);
    EXPECT_LT((analytic.col(i) - numeric).cwiseAbs().maxCoeff(), 1e-6) << "column " << i;
  }
}

/// A circle of radius 2 m at 1.5 rad/s, level, nose along the way: what an IMU feels on it, exactly.
constexpr double kRadius_m = 2.0;
constexpr double kRate_radps = 1.5;

std::vector<sync::GroupImu> circle_imu(double begin_s, double end_s) {
  std::vector<sync::GroupImu> imu;
  for (double t = begin_s; t < end_s + 0.005; t += 0.005) {
    imu.push_back(
        {HostTime(from_seconds(t)), {0, 0, kRate_radps}, {0, kRadius_m * kRate_radps * kRate_radps, 9.81}});
  }
  return imu;
}

FilterBelief circle_start() {
  FilterBelief belief;
  belief.state.velocity_in_odom_mps = {kRadius_m * kRate_radps, 0, 0};
  belief.covariance = 1e-6 * ErrorMatrix::Identity();
  return belief;
}

TEST(Propagation, FollowsACircleForASecond) {
  const Interval interval{HostTime(from_seconds(0.0023)), HostTime(from_seconds(1.0023))};
  const Prediction prediction = predict_with_imu(circle_start(), circle_imu(0.0, 1.1), {}, {}, interval);
  const Vector3d truth(kRadius_m * std::sin(kRate_radps), kRadius_m * (1.0 - std::cos(kRate_radps)), 0.0);
  EXPECT_LT((prediction.belief.state.odom_from_body.translation_m - truth).norm(), 2e-4);
  EXPECT_NEAR(geometry::so3_log(prediction.belief.state.odom_from_body.rotation).z(), kRate_radps, 1e-9);
  EXPECT_TRUE(prediction.imu_covers);
  EXPECT_EQ(prediction.path.front().stamp, interval.begin);
  EXPECT_EQ(prediction.path.back().stamp, interval.end);
}

TEST(Propagation, CovarianceGrowsByTheNoiseDensities) {
  // At rest and over a short time, white noise alone: rotation s^2 t, velocity s^2 t + (g s_rot)^2 t^3 / 3 on
  // the axes that feel gravity.
  FilterBelief belief;
  belief.covariance.setZero();
  const sensor::ImuModel model;
  std::vector<sync::GroupImu> imu;
  for (int i = 0; i <= 100; ++i)
    imu.push_back({HostTime(from_seconds(0.005 * i)), Vector3d::Zero(), {0, 0, 9.81}});
  const Prediction prediction =
      predict_with_imu(belief, imu, model, {}, {HostTime{}, HostTime(from_seconds(0.5))});
  const ErrorMatrix& p = prediction.belief.covariance;
  const double rotation = model.gyro_noise_radps_per_sqrt_hz * model.gyro_noise_radps_per_sqrt_hz * 0.5;
  const double velocity = model.accel_noise_mps2_per_sqrt_hz * model.accel_noise_mps2_per_sqrt_hz * 0.5;
  EXPECT_NEAR(p(kRot, kRot), rotation, 0.01 * rotation);
  EXPECT_NEAR(p(kVel + 2, kVel + 2), velocity, 0.01 * velocity);
  EXPECT_NEAR(p(kPos + 2, kPos + 2), velocity * 0.25 / 3.0, 0.02 * velocity * 0.25 / 3.0);
}

TEST(Propagation, BridgesAHoleAndSaysSo) {
  std::vector<sync::GroupImu> imu = circle_imu(0.0, 1.0);
  imu.erase(imu.begin() + 40, imu.begin() + 100);  // 0.2 s to 0.5 s
  const MotionNoise free_motion{0.5, 1.0, 0.0, 0.0};
  const Prediction bridged =
      predict_with_imu(circle_start(), imu, {}, free_motion, {HostTime{}, HostTime(from_seconds(0.9))});
  const Prediction whole = predict_with_imu(circle_start(), circle_imu(0.0, 1.0), {}, free_motion,
                                            {HostTime{}, HostTime(from_seconds(0.9))});
  EXPECT_FALSE(bridged.imu_covers);
  EXPECT_TRUE(whole.imu_covers);
  EXPECT_GT(bridged.belief.covariance(kPos, kPos), 10.0 * whole.belief.covariance(kPos, kPos));
  const Vector3d error =
      bridged.belief.state.odom_from_body.translation_m - whole.belief.state.odom_from_body.translation_m;
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_LT(std::abs(error(axis)), 4.0 * std::sqrt(bridged.belief.covariance(kPos + axis, kPos + axis)));
  }
}

TEST(Propagation, WithoutImuTheVelocityAndTheRateHold) {
  FilterBelief belief;
  belief.state.gravity_in_odom_mps2.setZero();
  belief.state.velocity_in_odom_mps = {2, 1, 0};
  belief.state.gyro_bias_radps = {0, 0, -0.5};
  belief.covariance.setZero();
  const MotionNoise noise{0.0, 1.0, 0.5, 0.0};
  const Prediction prediction = predict_without_imu(belief, noise, {HostTime{}, HostTime(from_seconds(0.4))});
  EXPECT_TRUE(prediction.belief.state.odom_from_body.translation_m.isApprox(Vector3d(0.8, 0.4, 0.0), 1e-9));
  EXPECT_NEAR(geometry::so3_log(prediction.belief.state.odom_from_body.rotation).z(), 0.2, 1e-9);
  EXPECT_NEAR(prediction.belief.covariance(kVel, kVel), 0.4, 1e-9);
  EXPECT_NEAR(prediction.belief.covariance(kRot + 2, kRot + 2), 0.25 * 0.064 / 3.0,
              0.05 * 0.25 * 0.064 / 3.0);
}

TEST(Propagation, ACorrectedPathEndsAtTheCorrectedPoseAndKeepsItsPast) {
  FilterState predicted;
  predicted.velocity_in_odom_mps = {1, 0, 0};
  const HostTime end(from_seconds(0.1));
  std::vector<PathKnot> path = uniform_path(predicted, end, {HostTime{}, end});
  FilterState corrected = predicted;
  corrected.velocity_in_odom_mps.x() = 1.5;
  corrected.odom_from_body.translation_m.x() = 0.05;  // just what the speed was wrong by
  correct_path(path, end, predicted, corrected);
  EXPECT_TRUE(path.back().odom_from_body.translation_m.isApprox(Vector3d(0.05, 0, 0), 1e-12));
  EXPECT_TRUE(path.front().odom_from_body.translation_m.isApprox(Vector3d(-0.1, 0, 0), 1e-12));
}

}  // namespace
}  // namespace edgesplat::tracking
