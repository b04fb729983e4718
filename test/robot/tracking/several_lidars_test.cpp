// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Several LiDARs on one body: their points in one frame, each with the noise and the place of its own LiDAR.
#include "common/geometry/so3.hpp"
#include "robot/tracking/scan_update.hpp"
#include "robot/tracking/sweep.hpp"
#include "robot/tracking/tracker.hpp"
#include "test/support/simulated_groups.hpp"
#include "test/tools/simulate/box_world.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>

namespace edgesplat::tracking {
namespace {

const simulate::BoxWorld kRoom;

sensor::LidarMount second_lidar() {
  sensor::LidarMount mount;
  mount.model.bearing_sigma_rad = 0.0013;
  mount.body_from_lidar.translation_m = {-0.35, 0.12, -0.08};
  mount.body_from_lidar.rotation =
      Eigen::AngleAxisd(2.8, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY());
  return mount;
}

test::SimulatedDriveConfig drive_config() {
  test::SimulatedDriveConfig config;
  config.trajectory.duration_s = 10.0;
  config.keep_every_packet = 8;  // two LiDARs give as many points as one does with every fourth
  config.more_lidars = {second_lidar()};
  return config;
}

struct Errors {
  double largest_m = 0.0;  ///< from the first pose on
  double rms_m = 0.0;
  int poses = 0;
  int coasted = 0;
};

/// Tracks to the end; `change` may take points out of a group that ends at this time, in seconds.
Errors drive(const test::SimulatedDriveConfig& config,
             const std::function<void(sync::MeasureGroup&, double)>& change = {}) {
  test::SimulatedDrive source(kRoom, config);
  const auto tracker = Tracker::create({}, source.rig());
  EXPECT_TRUE(tracker.has_value());
  Errors errors;
  std::optional<geometry::RigidTransform> odom_from_world;
  for (int i = 1; auto group = source.next(); ++i) {
    if (change) change(*group, i * config.group_s);
    const auto tracked = (*tracker)->track(*group);
    EXPECT_TRUE(tracked.has_value());
    if (tracked->health.state == TrackingState::kInitialising) continue;
    const auto world_from_body = source.truth(tracked->stamp).world_from_body;
    if (!odom_from_world) odom_from_world = tracked->odom_from_body * world_from_body.inverse();
    const Eigen::Vector3d truth = (*odom_from_world * world_from_body).translation_m;
    const double error_m = (tracked->odom_from_body.translation_m - truth).norm();
    errors.largest_m = std::max(errors.largest_m, error_m);
    errors.rms_m += error_m * error_m;
    errors.coasted += tracked->health.state == TrackingState::kCoasting ? 1 : 0;
    ++errors.poses;
  }
  errors.rms_m = std::sqrt(errors.rms_m / std::max(1, errors.poses));
  return errors;
}

void without_unit(sync::MeasureGroup& group, std::uint8_t unit) {
  std::erase_if(group.points, [unit](const sync::GroupPoint& point) { return point.unit == unit; });
}

/// The body at a moment of an even drive that turns: 3 m/s and 0.8 rad/s.
geometry::RigidTransform even_pose(double time_s) {
  geometry::RigidTransform pose;
  pose.rotation = Eigen::AngleAxisd(0.8 * time_s, Eigen::Vector3d::UnitZ());
  pose.translation_m = {3.0 * time_s, 0.5 * time_s, 0.0};
  return pose;
}

TEST(SeveralLidars, PutTheSamePlaceAtTheSamePlace) {
  sensor::Rig rig;
  rig.body_from_lidar.translation_m = {-0.011, -0.023, 0.044};
  rig.body_from_lidar.rotation = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX());
  rig.more_lidars = {second_lidar(), second_lidar()};
  rig.more_lidars[1].body_from_lidar = {Eigen::Quaterniond::Identity(), {0.4, -0.3, 0.2}};
  const Eigen::Vector3d place(4.0, -2.5, 1.2);
  sync::MeasureGroup group;
  group.begin = host_time_from_ns(1'000'000'000);
  group.end = host_time_from_ns(1'100'000'000);
  std::vector<PathKnot> path;
  for (int i = 0; i <= 20; ++i)
    path.push_back({group.begin + nanoseconds(5'000'000 * i), even_pose(-0.1 + 0.005 * i)});
  // All stamps late by a delay that is known, all LiDARs moved together with the first one: the same.
  const geometry::RigidTransform moved(geometry::so3_exp({0.01, -0.02, 0.015}), {0.02, -0.01, 0.03});
  for (const double delay_s : {0.0, 0.008, -0.008}) {
    SensorCalibration calibration{delay_s, 0.0, rig.body_from_lidar};
    if (delay_s != 0.0) calibration.body_from_lidar = moved * rig.body_from_lidar;
    const geometry::RigidTransform change = calibration.body_from_lidar * rig.body_from_lidar.inverse();
    group.points.clear();
    for (int i = 99; i >= 0; --i) {
      const auto unit = static_cast<std::uint8_t>(i % 3);
      const geometry::RigidTransform odom_from_lidar =
          even_pose(-0.001 * i + delay_s) * change * rig.mount_of(unit).body_from_lidar;
      group.points.push_back(
          {(odom_from_lidar.inverse() * place).cast<float>(), 0.5F, 1'000'000 * i, 0, unit});
    }
    BlockLoop loop(1);
    Sweep sweep(rig, 100.0, loop);
    TrackingCounters counters;
    sweep.load(group, counters);
    sweep.deskew(path, geometry::RigidTransform(), calibration);
    ASSERT_EQ(sweep.points_in_body_m().size(), 100U);
    for (const Eigen::Vector3f& p : sweep.points_in_body_m())
      EXPECT_LT((p.cast<double>() - place).norm(),
                3e-4);  // the path is straight between and beyond its knots
    EXPECT_EQ(std::ranges::count(sweep.units(), 1), 33);
  }
}

TEST(SeveralLidars, HaveLimitsOfTheirOwnAndNoPlaceOutsideTheRig) {
  sensor::Rig rig;
  rig.lidar.min_range_m = 1.0;
  rig.more_lidars = {second_lidar()};
  rig.more_lidars[0].model.min_range_m = 3.0;
  rig.more_lidars[0].model.max_range_m = 10.0;
  sync::MeasureGroup group;
  group.end = host_time_from_ns(100);
  const auto at = [&](float range_m, std::uint8_t unit) {
    group.points.push_back({{range_m, 0.0F, 0.0F}, 0.5F, 0, 0, unit});
  };
  at(2.0F, 0);   // kept
  at(2.0F, 1);   // too near for the second
  at(20.0F, 0);  // kept
  at(20.0F, 1);  // too far for the second
  at(5.0F, 1);   // kept
  at(5.0F, 2);   // nobody's
  BlockLoop loop(1);
  Sweep sweep(rig, 100.0, loop);
  TrackingCounters counters;
  sweep.load(group, counters);
  EXPECT_EQ(sweep.units().size(), 3U);
  EXPECT_EQ(counters.out_of_range_points, 2);
  EXPECT_EQ(counters.bad_points, 1);
}

TEST(SeveralLidars, HaveNoiseOfTheirOwnAroundRaysFromTheirOwnPlace) {
  sensor::LidarModel model;
  model.range_sigma_m = 0.02;
  model.bearing_sigma_rad = 0.001;
  sensor::LidarMount mount = second_lidar();
  mount.model.range_sigma_m = 0.1;
  mount.model.bearing_sigma_rad = 0.01;
  mount.body_from_lidar.translation_m = {0.0, 0.0, 5.0};
  const Beam beams[] = {{Eigen::Vector3f::Zero(), PointNoise(model)}, beam_of(mount)};
  const Eigen::Vector3f points[] = {{5.0F, 0.0F, 5.0F}, {5.0F, 0.0F, 5.0F}};
  const std::uint8_t units[] = {0, 1};
  const ScanView view{points, beams, units};
  const Eigen::Vector3f x(1.0F, 0.0F, 0.0F), z(0.0F, 0.0F, 1.0F);
  // Seen from the first the ray is slanted by 45 degrees, from the second it is along x, 5 m long.
  const float along = 0.02F * 0.02F, across = 0.001F * 0.001F * 50.0F;
  EXPECT_NEAR(view.variance_along(0, x), 0.5F * (along + across), 1e-7F);
  EXPECT_NEAR(view.variance_along(1, x), 0.1F * 0.1F, 1e-7F);
  EXPECT_NEAR(view.variance_along(1, z), 0.01F * 0.01F * 25.0F, 1e-7F);
  const ScanView of_one{points, beams};
  EXPECT_EQ(of_one.variance_along(1, x), view.variance_along(0, x));
}

TEST(SeveralLidars, TrackAsWellAsOne) {
  const Errors errors = drive(drive_config());
  EXPECT_LT(errors.largest_m, 0.02);
  EXPECT_GE(errors.poses, 95);
  EXPECT_EQ(errors.coasted, 0);
}

TEST(SeveralLidars, TheTrackHoldsWithoutEitherOfThem) {
  for (const std::uint8_t unit : {std::uint8_t{0}, std::uint8_t{1}}) {
    const Errors errors = drive(drive_config(), [unit](sync::MeasureGroup& group, double end_s) {
      if (end_s > 4.0 && end_s < 7.0) without_unit(group, unit);
    });
    EXPECT_LT(errors.largest_m, 0.02) << int{unit};
    EXPECT_EQ(errors.coasted, 0);
  }
}

TEST(SeveralLidars, ANoisyOneIsToldFromAGoodOne) {
  // The second's points are 5 cm off in any direction. Where its model says so they spoil less.
  const auto with_model = [](double range_sigma_m, double bearing_sigma_rad) {
    test::SimulatedDriveConfig config = drive_config();
    config.more_lidars[0].model.range_sigma_m = range_sigma_m;
    config.more_lidars[0].model.bearing_sigma_rad = bearing_sigma_rad;
    simulate::NoiseStream noise(5, simulate::NoisePurpose::kLidarShot, 0);
    return drive(config, [&noise](sync::MeasureGroup& group, double) {
      for (sync::GroupPoint& point : group.points)
        if (point.unit == 1) point.p_in_lidar_m += (0.05 * noise.gaussian3()).cast<float>();
    });
  };
  const Errors honest = with_model(0.05, 0.015);
  const Errors boasting = with_model(0.005, 0.0005);
  EXPECT_LT(honest.largest_m, 0.02);
  EXPECT_LT(honest.rms_m, 0.95 * boasting.rms_m);
}

TEST(SeveralLidars, OneWithoutUsableNoiseIsRefusedByName) {
  sensor::Rig rig;
  rig.more_lidars = {second_lidar()};
  rig.more_lidars[0].model.bearing_sigma_rad = 0.0;
  const auto tracker = Tracker::create({}, rig);
  ASSERT_FALSE(tracker.has_value());
  EXPECT_NE(tracker.error().context.find("LiDAR 1 of rig"), std::string::npos);
}

}  // namespace
}  // namespace edgesplat::tracking
