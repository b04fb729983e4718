// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/calibration_watch.hpp"

#include "common/geometry/so3.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;

const geometry::RigidTransform kMounting{Eigen::Quaterniond::Identity(), {0.1, 0.0, 0.2}};

TrackingConfig all_unknown() {
  TrackingConfig config;
  config.lidar_delay_sigma_s = config.camera_delay_sigma_s = 0.01;
  config.lidar_turn_sigma_rad = 0.02;
  config.lidar_step_sigma_m = 0.02;
  return config;
}

/// What 4 s of a motion show: `pose` at a time.
SensorOffsets watched(const std::function<geometry::RigidTransform(double)>& pose) {
  CalibrationWatch watch(all_unknown());
  FilterBelief belief;
  watch.begin(belief, kMounting, true);
  for (double t = 0.0; t < 4.0; t += 0.1) {
    std::vector<PathKnot> path;
    for (double s = t; s < t + 0.1001; s += 0.005) path.push_back({HostTime(from_seconds(s)), pose(s)});
    belief.state.odom_from_body = path.back().odom_from_body;
    watch.add(path.back().stamp, belief.state, twist_at_end(path, from_seconds(0.1)),
              twist_at_end(path, from_seconds(0.02)));
  }
  return watch.report(belief, kMounting);
}

geometry::RigidTransform level(double yaw, const Vector3d& p) {
  return {geometry::so3_exp({0.0, 0.0, yaw}), p};
}

TEST(CalibrationWatch, NothingShowsAtRestNorStraightAheadAtConstantSpeed) {
  for (const double speed_mps : {0.0, 1.0, 15.0}) {
    const SensorOffsets offsets = watched([&](double t) { return level(0.4, {speed_mps * t, 0.0, 0.0}); });
    EXPECT_TRUE(offsets.lidar_delay_frozen);
    EXPECT_TRUE(offsets.camera_delay_frozen);
    EXPECT_EQ(offsets.frozen_turns, 3);
    EXPECT_EQ(offsets.frozen_steps, 3);
  }
}

TEST(CalibrationWatch, ACircleAtConstantSpeedShowsNoDelay) {
  const SensorOffsets offsets = watched([](double t) {
    return level(0.8 * t, {100.0 + 2.0 * std::sin(0.8 * t), 50.0 - 2.0 * std::cos(0.8 * t), 0.0});
  });
  EXPECT_TRUE(offsets.lidar_delay_frozen);
  EXPECT_TRUE(offsets.camera_delay_frozen);
  // Turning about one axis shows everything but what lies along it.
  EXPECT_EQ(offsets.frozen_turns, 1);
  EXPECT_EQ(offsets.frozen_steps, 1);
}

TEST(CalibrationWatch, SpeedingUpAndSwayingShowDelays) {
  const auto faster = watched([](double t) { return level(0.0, {0.4 * t * t, 0.0, 0.0}); });
  EXPECT_FALSE(faster.lidar_delay_frozen);
  EXPECT_EQ(faster.frozen_turns, 3);
  const auto swaying = watched([](double t) { return level(0.1 * std::sin(3.0 * t), {t, 0.0, 0.0}); });
  EXPECT_FALSE(swaying.lidar_delay_frozen);
  EXPECT_FALSE(swaying.camera_delay_frozen);
}

TEST(CalibrationWatch, TurningAboutAllAxesShowsAll) {
  const auto offsets = watched([](double t) {
    return geometry::RigidTransform{
        geometry::so3_exp({0.4 * std::sin(2.0 * t), 0.4 * std::sin(3.1 * t), 0.5 * t}), {t, 0.0, 0.0}};
  });
  EXPECT_FALSE(offsets.lidar_delay_frozen);
  EXPECT_EQ(offsets.frozen_turns, 0);
  EXPECT_EQ(offsets.frozen_steps, 0);
}

TEST(CalibrationWatch, EstimatesWhatItIsToldTo) {
  EXPECT_FALSE(
      CalibrationWatch(TrackingConfig{.lidar_delay_sigma_s = 0.0, .camera_delay_sigma_s = 0.0}).estimates());
  TrackingConfig config{.lidar_delay_s = 0.003, .lidar_delay_sigma_s = 0.0, .camera_delay_sigma_s = 0.005};
  const CalibrationWatch watch(config);
  EXPECT_TRUE(watch.estimates());
  FilterBelief belief;
  watch.begin(belief, kMounting, true);
  EXPECT_EQ(belief.state.calibration.lidar_delay_s, 0.003);
  ASSERT_TRUE(belief.calibration.has_value());
  EXPECT_EQ(belief.calibration->covariance(kLidarDelay, kLidarDelay), 0.0);
  EXPECT_NEAR(belief.calibration->covariance(kCameraDelay, kCameraDelay), 25e-6, 1e-12);
  EXPECT_TRUE(belief.state.calibration.body_from_lidar.matrix().isApprox(kMounting.matrix()));
  // Nothing tells what the time of scans is where there is no IMU.
  watch.begin(belief, kMounting, false);
  EXPECT_EQ(belief.state.calibration.lidar_delay_s, 0.0);
  EXPECT_FALSE(belief.calibration.has_value());
}

}  // namespace
}  // namespace edgesplat::tracking
