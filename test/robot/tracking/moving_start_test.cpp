// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The tracker begun in the middle of a drive, whole and with what can go wrong then.
#include "robot/tracking/moving_start.hpp"
#include "test/support/simulated_groups.hpp"
#include "test/tools/simulate/box_world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace edgesplat::tracking {
namespace {

const simulate::BoxWorld kRoom;
constexpr int kSkipped = 40;  // groups: the robot has stood for 1.5 s and drives at full speed

struct Start {
  int groups_waited = 0;              ///< to the first pose
  double tilt_deg = 180.0;            ///< of odom's z, at the first pose
  double velocity_error_mps = 100.0;  ///< at the first pose
  double worst_m = 0.0;               ///< of all positions, aligned at the first pose, heading included
  TrackingCounters counters;
};

double tilt_deg(const TrackedGroup& tracked, const simulate::BodyState& truth) {
  const Eigen::Vector3d up = tracked.odom_from_body.rotation *
                             (truth.world_from_body.rotation.conjugate() * Eigen::Vector3d::UnitZ());
  return std::acos(std::clamp(up.z(), -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

Start start(double spin_radps, const TrackingConfig& config = {},
            const std::function<void(int, sync::MeasureGroup&)>& spoil = {}, double duration_s = 12.0,
            int skipped = kSkipped) {
  test::SimulatedDriveConfig drive;
  drive.trajectory.duration_s = duration_s;
  drive.trajectory.spin_radps = spin_radps;
  drive.keep_every_packet = 4;
  test::SimulatedDrive source(kRoom, drive);
  auto tracker = Tracker::create(config, source.rig());
  EXPECT_TRUE(tracker.has_value());
  Start result;
  std::optional<geometry::RigidTransform> odom_from_world;
  for (int i = 0; auto group = source.next(); ++i) {
    if (i < skipped) continue;
    if (spoil) spoil(i - skipped, *group);
    const auto tracked = (*tracker)->track(*group);
    EXPECT_TRUE(tracked.has_value());
    if (tracked->health.state == TrackingState::kInitialising) {
      ++result.groups_waited;
      EXPECT_TRUE(tracked->points_in_body.empty());
      continue;
    }
    const auto truth = source.truth(tracked->stamp);
    if (!odom_from_world) {
      odom_from_world = tracked->odom_from_body * truth.world_from_body.inverse();
      result.tilt_deg = tilt_deg(*tracked, truth);
      result.velocity_error_mps =
          (tracked->velocity_in_odom_mps - odom_from_world->rotation * truth.velocity_mps).norm();
      EXPECT_TRUE(tracked->odom_from_body.translation_m.isZero());
    }
    const Eigen::Vector3d off =
        tracked->odom_from_body.translation_m - (*odom_from_world * truth.world_from_body).translation_m;
    result.worst_m = std::max(result.worst_m, off.norm());
  }
  result.counters = (*tracker)->counters();
  return result;
}

TEST(MovingStart, FindsLevelAndSpeedWhileItDrives) {
  const Start driving = start(0.0);
  EXPECT_LE(driving.groups_waited, 15);  // 1.5 s
  EXPECT_LT(driving.tilt_deg, 0.6);      // the accelerometer's bias of 0.1 m/s^2 allows no better
  EXPECT_LT(driving.velocity_error_mps, 0.03);
  EXPECT_LT(driving.worst_m, 0.05);
  EXPECT_EQ(driving.counters.moving_starts, 1);
  EXPECT_EQ(driving.counters.refused_starts, 0);
  EXPECT_EQ(driving.counters.coasted_groups, 0);
}

TEST(MovingStart, FindsThemWhileItTurnsOnItself) {
  const Start spinning = start(2.0);
  EXPECT_LE(spinning.groups_waited, 20);
  EXPECT_LT(spinning.tilt_deg, 0.6);
  EXPECT_LT(spinning.velocity_error_mps, 0.05);
  EXPECT_LT(spinning.worst_m, 0.05);
  EXPECT_EQ(spinning.counters.moving_starts, 1);
}

TEST(MovingStart, WaitsForRestAsLongAsItIsTold) {
  TrackingConfig config;
  config.init_rest_wait_s = 4.0;
  const Start patient = start(0.0, config);
  EXPECT_GE(patient.groups_waited, 39);
  EXPECT_LE(patient.groups_waited, 45);
  EXPECT_LT(patient.tilt_deg, 0.6);
  config.init_rest_wait_s = 600.0;
  const Start never = start(0.0, config);
  EXPECT_EQ(never.counters.moving_starts, 0);
  EXPECT_EQ(never.groups_waited, 80);
}

TEST(MovingStart, TakesRestWhereItComesFirst) {
  // It stands, and somebody knocks at it for the first 0.6 s.
  const auto knocked = [](int i, sync::MeasureGroup& group) {
    for (std::size_t k = 0; i < 6 && k < group.imu.size(); k += 2) group.imu[k].accel_mps2.x() += 2.0;
  };
  const Start rest = start(0.0, {}, knocked, 5.0, 0);
  EXPECT_GE(rest.groups_waited, 6);
  EXPECT_LE(rest.groups_waited, 10);
  EXPECT_EQ(rest.counters.moving_starts, 0);
  EXPECT_LT(rest.worst_m, 0.05);
}

// Once in some dozen starts the second scan of a tunnel matches the first at a speed along it that is no
// speed at all, and no later scan says otherwise.
TEST(MovingStart, SeesRestInATunnelWhateverTheScansSayAlongIt) {
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto tunnel = simulate::World::create({.name = "tunnel", .seed = seed});
    ASSERT_TRUE(tunnel.has_value());
    test::SimulatedDriveConfig drive;
    drive.trajectory.duration_s = 1.0;  // it stands
    drive.seed = seed;
    test::SimulatedDrive source(**tunnel, drive);
    const auto tracker = Tracker::create({}, source.rig());
    ASSERT_TRUE(tracker.has_value());
    int waited = 0;
    while (auto group = source.next()) {
      const auto tracked = (*tracker)->track(*group);
      ASSERT_TRUE(tracked.has_value());
      if (tracked->health.state == TrackingState::kInitialising) ++waited;
    }
    EXPECT_LE(waited, 4) << seed;
  }
}

TEST(MovingStart, RefusesAnAccelerometerThatFeelsNoWeight) {
  const auto falling = [](int, sync::MeasureGroup& group) {
    for (auto& sample : group.imu) sample.accel_mps2 -= Eigen::Vector3d(0.0, 0.0, 9.81);
  };
  const Start refused = start(0.0, {}, falling);
  EXPECT_EQ(refused.groups_waited, 80);
  EXPECT_EQ(refused.counters.moving_starts, 0);
  EXPECT_GT(refused.counters.refused_starts, 5);
}

TEST(MovingStart, GathersAnewAfterAGapOfTheImu) {
  const auto gap = [](int i, sync::MeasureGroup& group) {
    if (i == 10) group.imu.erase(group.imu.begin() + 3, group.imu.end() - 3);
  };
  const Start late = start(0.0, {}, gap);
  EXPECT_GE(late.groups_waited, 20);
  EXPECT_LE(late.groups_waited, 26);
  EXPECT_LT(late.tilt_deg, 0.6);
  EXPECT_LT(late.velocity_error_mps, 0.03);
  EXPECT_LT(late.worst_m, 0.05);
}

TEST(MovingStart, BeginsWithTheLidar) {
  const auto blind = [](int i, sync::MeasureGroup& group) {
    if (i < 30) group.points.clear();
  };
  const Start late = start(0.0, {}, blind);
  EXPECT_GE(late.groups_waited, 40);
  EXPECT_LE(late.groups_waited, 46);
  EXPECT_LT(late.tilt_deg, 0.6);
  EXPECT_LT(late.worst_m, 0.05);
  const auto out_between = [](int i, sync::MeasureGroup& group) {
    if (i >= 8 && i < 40) group.points.clear();
  };
  const Start again = start(0.0, {}, out_between);
  EXPECT_GE(again.groups_waited, 50);
  EXPECT_LE(again.groups_waited, 60);
  EXPECT_LT(again.tilt_deg, 0.6);
  EXPECT_LT(again.worst_m, 0.05);
}

}  // namespace
}  // namespace edgesplat::tracking
