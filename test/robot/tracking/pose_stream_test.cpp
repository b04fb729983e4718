// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/pose_stream.hpp"

#include "common/geometry/so3.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::tracking {
namespace {

using namespace std::chrono_literals;
using Eigen::Vector3d;

constexpr double kRadius_m = 5.0, kRate_radps = 0.4;
const Vector3d kGyroBias(0.01, -0.02, 0.005), kAccelBias(0.1, 0.05, -0.2);

HostTime at(nanoseconds t) {
  return HostTime{} + 100s + t;
}

/// A body that drives a circle, looking along its way.
geometry::RigidTransform true_pose(nanoseconds t) {
  const double angle = kRate_radps * to_seconds(t);
  return {geometry::so3_exp(Vector3d(0, 0, angle)),
          kRadius_m * Vector3d(std::sin(angle), -std::cos(angle), 0)};
}
Vector3d true_velocity(nanoseconds t) {
  const double angle = kRate_radps * to_seconds(t);
  return kRadius_m * kRate_radps * Vector3d(std::cos(angle), std::sin(angle), 0);
}
sync::GroupImu sample(nanoseconds t) {
  const Vector3d towards_centre(0, kRadius_m * kRate_radps * kRate_radps, 0);
  return {at(t), Vector3d(0, 0, kRate_radps) + kGyroBias, towards_centre + Vector3d(0, 0, 9.81) + kAccelBias};
}
TrackedGroup tracked(nanoseconds t, TrackingState state = TrackingState::kTracking) {
  TrackedGroup group;
  group.stamp = at(t);
  group.odom_from_body = true_pose(t);
  group.velocity_in_odom_mps = true_velocity(t);
  group.gyro_bias_radps = kGyroBias;
  group.accel_bias_mps2 = kAccelBias;
  group.health.state = state;
  return group;
}

TEST(PoseStream, FollowsATrueMotionBetweenTrackedStates) {
  PoseStream stream;
  int poses = 0;
  for (nanoseconds t = 0ms; t < 2s; t += 5ms) {
    // Tracking's results come 60 ms late and between two samples.
    if (t % 100ms == 60ms && t > 60ms) stream.correct(tracked(t - 62ms));
    const auto pose = stream.on_sample(sample(t));
    if (!pose) continue;
    ++poses;
    EXPECT_EQ(pose->stamp, at(t));
    EXPECT_LT((pose->odom_from_body.translation_m - true_pose(t).translation_m).norm(), 1e-4);
    EXPECT_LT(pose->odom_from_body.rotation.angularDistance(true_pose(t).rotation), 1e-6);
    EXPECT_LT((pose->velocity_in_odom_mps - true_velocity(t)).norm(), 2e-3);
    EXPECT_LT((pose->turn_in_body_radps - Vector3d(0, 0, kRate_radps)).norm(), 1e-9);
    EXPECT_LE(pose->since_tracked, 162ms);
  }
  EXPECT_EQ(poses, 368);  // from 160 ms on
}

TEST(PoseStream, ACorrectionMovesWhatFollows) {
  PoseStream stream;
  for (nanoseconds t = 0ms; t <= 100ms; t += 5ms) (void)stream.on_sample(sample(t));
  auto shifted = tracked(50ms);
  shifted.odom_from_body.translation_m.x() += 1.0;
  stream.correct(shifted);
  const auto pose = stream.on_sample(sample(105ms));
  ASSERT_TRUE(pose.has_value());
  EXPECT_NEAR(pose->odom_from_body.translation_m.x() - true_pose(105ms).translation_m.x(), 1.0, 1e-4);
  EXPECT_EQ(pose->since_tracked, 55ms);
}

TEST(PoseStream, SaysNothingOfAPoseThatIsNotKnown) {
  PoseStream stream;
  EXPECT_FALSE(stream.on_sample(sample(0ms)));
  stream.correct(tracked(0ms, TrackingState::kInitialising));
  EXPECT_FALSE(stream.on_sample(sample(5ms)));
  stream.correct(tracked(6ms));
  EXPECT_TRUE(stream.on_sample(sample(10ms)));
  stream.correct(tracked(12ms, TrackingState::kLost));
  EXPECT_FALSE(stream.on_sample(sample(15ms)));
}

TEST(PoseStream, OldDuplicateAndFarSamplesAreNotIntegrated) {
  PoseStream stream;
  (void)stream.on_sample(sample(0ms));
  stream.correct(tracked(1ms));
  EXPECT_TRUE(stream.on_sample(sample(5ms)));
  EXPECT_FALSE(stream.on_sample(sample(5ms)));
  EXPECT_FALSE(stream.on_sample(sample(3ms)));
  EXPECT_TRUE(stream.on_sample(sample(10ms)));
  EXPECT_FALSE(stream.on_sample(sample(150ms))) << "over a hole";
  EXPECT_FALSE(stream.on_sample(sample(155ms)));
  stream.correct(tracked(151ms));
  EXPECT_TRUE(stream.on_sample(sample(160ms)));
}

TEST(PoseStream, EndsWhereNothingWasTrackedForTooLong) {
  PoseStream stream;
  (void)stream.on_sample(sample(0ms));
  stream.correct(tracked(1ms));
  int poses = 0;
  for (nanoseconds t = 5ms; t < 3s; t += 5ms) poses += stream.on_sample(sample(t)) ? 1 : 0;
  EXPECT_EQ(poses, 200);
}

TEST(PoseStream, KeepsABoundedNumberOfSamples) {
  PoseStream stream({.longest_carry = 100s, .most_samples = 50});
  for (nanoseconds t = 0ms; t < 2s; t += 5ms) (void)stream.on_sample(sample(t));
  stream.correct(tracked(0ms));  // the samples next to it are gone: a hole
  EXPECT_FALSE(stream.on_sample(sample(2s)));
  stream.correct(tracked(1900ms));
  EXPECT_TRUE(stream.on_sample(sample(2005ms)));
}

}  // namespace
}  // namespace edgesplat::tracking
