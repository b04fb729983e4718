// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Delays of LiDAR and camera and the LiDAR's mounting found while it drives, where the motion shows them, and
// left alone where it does not.
#include "common/geometry/so3.hpp"
#include "robot/tracking/tracker.hpp"
#include "test/support/simulated_groups.hpp"
#include "test/support/trajectory_error.hpp"
#include "test/tools/simulate/box_world.hpp"
#include "tools/simulate/camera_render.hpp"
#include "tools/simulate/camera_sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

namespace edgesplat::tracking {
namespace {

const simulate::BoxWorld kRoom;

/// The same room, driven through straight ahead.
class StraightThroughTheRoom final : public simulate::World {
 public:
  std::optional<simulate::Hit> cast(const simulate::Ray& ray, simulate::Visibility v) const override {
    return kRoom.cast(ray, v);
  }
  Eigen::Vector3f radiance(const simulate::Ray& ray, const std::optional<simulate::Hit>& hit, double size_m,
                           simulate::Visibility v) const override {
    return kRoom.radiance(ray, hit, size_m, v);
  }
  Path path() const override { return {{{-9, -1, 0.6}, {9, -1, 0.6}}, false, 1.2}; }
};

struct Drive {
  test::SimulatedDriveConfig config;
  TrackingConfig tracking;
  int skipped = 0;                     ///< groups
  std::optional<double> camera_off_s;  ///< a picture a group, its stamp so much later than it was taken
};

struct Found {
  std::vector<SensorOffsets> offsets;  ///< one a group with a pose
  double ate_m = 0.0;

  /// The farthest from `truth` from a group on.
  [[nodiscard]] double worst(double SensorOffsets::*delay_s, double truth_s, std::size_t from) const {
    double worst_s = 0.0;
    for (std::size_t i = from; i < offsets.size(); ++i)
      worst_s = std::max(worst_s, std::abs(offsets[i].*delay_s - truth_s));
    return worst_s;
  }
};

sensor::CameraMount camera() {
  sensor::CameraMount mount;
  mount.model = {geometry::CameraKind::kPinhole, 160, 128, 104.0, 104.0, 79.5, 63.5, {}};
  Eigen::Matrix3d body_from_camera;
  body_from_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  mount.body_from_camera = {Eigen::Quaterniond(body_from_camera), {0.08, 0.0, 0.03}};
  return mount;
}

void add_picture(const simulate::World& world, const test::SimulatedDrive& source, double off_s,
                 sync::MeasureGroup& group) {
  const simulate::CameraSensor exposure{simulate::CameraSensorConfig{}};
  const double time_s = to_seconds(group.end - HostTime{});
  const auto body = source.truth(group.end - from_seconds(off_s)).world_from_body;
  const auto picture =
      simulate::render_picture(world, {camera().model, body * camera().body_from_camera, time_s});
  const auto number = static_cast<std::uint32_t>(std::lround(10.0 * time_s));
  group.image =
      sync::GroupImage{std::make_shared<sensor::ImageRgb8>(exposure.expose(picture.full, number, time_s)),
                       static_cast<float>(exposure.exposure_s(time_s)), 0.0F, number};
}

Found drive(const simulate::World& world, const Drive& drive) {
  test::SimulatedDrive source(world, drive.config);
  sensor::Rig rig = source.rig();
  if (drive.camera_off_s) rig.camera = camera();
  auto tracker = Tracker::create(drive.tracking, rig);
  EXPECT_TRUE(tracker.has_value());
  Found found;
  std::vector<Eigen::Vector3d> estimate, truth;
  for (int i = 0; auto group = source.next(); ++i) {
    if (i < drive.skipped) continue;
    if (drive.camera_off_s) add_picture(world, source, *drive.camera_off_s, *group);
    const auto tracked = (*tracker)->track(*group);
    EXPECT_TRUE(tracked.has_value());
    if (tracked->health.state == TrackingState::kInitialising) continue;
    found.offsets.push_back(tracked->health.offsets);
    estimate.push_back(tracked->odom_from_body.translation_m);
    truth.push_back(source.truth(tracked->stamp).world_from_body.translation_m);
  }
  found.ate_m = test::absolute_error_m(estimate, truth);
  return found;
}

Drive in_a_room(double duration_s, double spin_radps) {
  Drive drive;
  drive.config.trajectory.duration_s = duration_s;
  drive.config.trajectory.spin_radps = spin_radps;
  drive.config.keep_every_packet = 4;
  return drive;
}

constexpr double kSpin_radps = 3.0;
constexpr std::size_t kSixSeconds = 60;

TEST(Offsets, ADelayOfTheLidarIsFoundWithinSixSecondsOfTurns) {
  Drive turns = in_a_room(12.0, kSpin_radps);
  const double right_m = drive(kRoom, turns).ate_m;
  for (const double late_s : {0.008, -0.012}) {
    turns.config.lidar_stamp_error_s = late_s;
    turns.tracking.lidar_delay_sigma_s = 0.0;
    EXPECT_GT(drive(kRoom, turns).ate_m, right_m + 0.002);  // it makes a difference
    turns.tracking.lidar_delay_sigma_s = 0.01;
    const Found found = drive(kRoom, turns);
    EXPECT_LT(found.worst(&SensorOffsets::lidar_delay_s, -late_s, kSixSeconds), 0.0005);
    EXPECT_LT(found.offsets.back().lidar_delay_sigma_s, 0.0005);
    EXPECT_FALSE(found.offsets.back().lidar_delay_frozen);
    EXPECT_LT(found.ate_m, right_m + 0.002);
  }
}

TEST(Offsets, ADelayThatAllOfSeveralLidarsHaveIsFound) {
  Drive turns = in_a_room(9.0, kSpin_radps);
  sensor::LidarMount second;
  second.model.bearing_sigma_rad = 0.0013;
  second.body_from_lidar.translation_m = {-0.35, 0.12, -0.08};
  second.body_from_lidar.rotation = Eigen::AngleAxisd(2.8, Eigen::Vector3d::UnitZ());
  turns.config.more_lidars = {second};
  turns.config.keep_every_packet = 8;
  turns.config.lidar_stamp_error_s = 0.008;
  turns.tracking.lidar_delay_sigma_s = 0.01;
  const Found found = drive(kRoom, turns);
  EXPECT_LT(found.worst(&SensorOffsets::lidar_delay_s, -0.008, kSixSeconds), 0.0005);
}

TEST(Offsets, ARightStampStaysRight) {
  Drive turns = in_a_room(12.0, kSpin_radps);
  const double held_m = drive(kRoom, turns).ate_m;
  turns.tracking.lidar_delay_sigma_s = 0.01;
  const Found found = drive(kRoom, turns);
  EXPECT_LT(found.worst(&SensorOffsets::lidar_delay_s, 0.0, kSixSeconds), 0.0005);
  EXPECT_LT(found.ate_m, held_m + 0.001);
}

TEST(Offsets, WhereLittleShowsADelayItsSigmaSaysSo) {
  for (const double late_s : {0.0, 0.008}) {
    Drive gentle = in_a_room(20.0, 0.0);
    gentle.config.lidar_stamp_error_s = late_s;
    gentle.tracking.lidar_delay_sigma_s = 0.01;
    const Found found = drive(kRoom, gentle);
    for (const SensorOffsets& offsets : found.offsets)
      EXPECT_LT(std::abs(offsets.lidar_delay_s + late_s), 2.5 * offsets.lidar_delay_sigma_s);
  }
}

TEST(Offsets, NothingIsLearntStandingStillOrStraightAheadAtConstantSpeed) {
  const StraightThroughTheRoom straight;
  for (const bool stands : {true, false}) {
    Drive even = in_a_room(stands ? 8.0 : 12.5, 0.0);
    even.config.trajectory.body_motion = 0.0;
    if (stands) even.config.trajectory.standstill_s = 10.0;
    even.config.lidar_stamp_error_s = 0.008;
    even.skipped = stands ? 0 : 36;
    even.tracking.lidar_delay_sigma_s = 0.01;
    even.tracking.lidar_turn_sigma_rad = even.tracking.lidar_step_sigma_m = 0.02;
    const Found found = drive(straight, even);
    ASSERT_GT(found.offsets.size(), 60U);
    for (const SensorOffsets& offsets : found.offsets) {
      EXPECT_TRUE(offsets.lidar_delay_frozen);
      EXPECT_EQ(offsets.frozen_turns, 3);
      EXPECT_EQ(offsets.frozen_steps, 3);
      EXPECT_EQ(offsets.lidar_delay_s, 0.0);
      EXPECT_GT(offsets.lidar_delay_sigma_s, 0.0099);
      EXPECT_TRUE(offsets.lidar_turn_rad.isZero(1e-12));
      EXPECT_TRUE(offsets.lidar_step_m.isZero(0.0));
    }
  }
}

TEST(Offsets, TheMountingIsFoundAsFarAsTurningAboutTheUprightShowsIt) {
  Drive turns = in_a_room(20.0, kSpin_radps);
  // The rig says the true one times this: to be taken back.
  turns.config.lidar_error = {geometry::so3_exp({0.0175, 0.0, 0.0}), {0.02, -0.02, 0.0}};
  const double wrong_m = drive(kRoom, turns).ate_m;
  turns.tracking.lidar_turn_sigma_rad = turns.tracking.lidar_step_sigma_m = 0.02;
  const Found found = drive(kRoom, turns);
  const SensorOffsets& last = found.offsets.back();
  EXPECT_EQ(last.frozen_turns, 1);
  EXPECT_EQ(last.frozen_steps, 1);
  EXPECT_LT((last.lidar_turn_rad.head<2>() - Eigen::Vector2d(-0.0175, 0.0)).norm(), 0.002);
  EXPECT_LT((last.lidar_step_m.head<2>() - Eigen::Vector2d(-0.02, 0.02)).norm(), 0.010);
  EXPECT_LT(std::abs(last.lidar_turn_rad.z()), 0.001);
  EXPECT_LT(std::abs(last.lidar_step_m.z()), 0.001);
  EXPECT_LT(found.ate_m, wrong_m);
}

// A small camera that sways a little tells some ms; recordings that turn, 0.1 ms (docs/benchmarks.md).
TEST(Offsets, ADelayOfTheCameraIsFoundAsFarAsItShows) {
  const auto world = simulate::World::create({.name = "corridor"});
  ASSERT_TRUE(world.has_value()) << world.error().context;
  Drive sways = in_a_room(9.0, 0.0);
  sways.tracking.camera_delay_sigma_s = 0.01;
  for (const double late_s : {0.012, 0.0}) {
    sways.camera_off_s = late_s;
    const Found found = drive(**world, sways);
    EXPECT_LT(found.worst(&SensorOffsets::camera_delay_s, -late_s, kSixSeconds), 0.005);
    for (const SensorOffsets& offsets : found.offsets)
      EXPECT_LT(std::abs(offsets.camera_delay_s + late_s), 2.5 * offsets.camera_delay_sigma_s);
    EXPECT_LT(found.offsets.back().camera_delay_sigma_s, 0.004);
  }
}

TEST(Offsets, WhatIsHeldIsNotTouched) {
  const Found found = drive(kRoom, in_a_room(4.0, kSpin_radps));
  for (const SensorOffsets& offsets : found.offsets) {
    EXPECT_EQ(offsets.lidar_delay_s, 0.0);
    EXPECT_EQ(offsets.lidar_delay_sigma_s, 0.0);
    EXPECT_TRUE(offsets.lidar_delay_frozen && offsets.camera_delay_frozen);
    EXPECT_EQ(offsets.frozen_turns + offsets.frozen_steps, 6);
    EXPECT_TRUE(offsets.lidar_turn_rad.isZero(1e-12) && offsets.lidar_step_m.isZero(0.0));
  }
}

TEST(Offsets, WhatIsNotSupportedIsRefused) {
  sensor::Rig rig;
  EXPECT_TRUE(Tracker::create({}, rig).has_value());
  EXPECT_FALSE(Tracker::create({.lidar_delay_sigma_s = 0.01}, rig).has_value());  // no IMU
  EXPECT_FALSE(Tracker::create({.lidar_delay_s = 0.01}, rig).has_value());
  rig.imu.emplace();
  EXPECT_TRUE(Tracker::create({.lidar_delay_s = 0.01, .gaussian_every = 1}, rig).has_value());
  EXPECT_FALSE(Tracker::create({.camera_delay_s = 0.01, .gaussian_every = 1}, rig).has_value());
  EXPECT_FALSE(Tracker::create({.lidar_turn_sigma_rad = 0.01, .gaussian_every = 1}, rig).has_value());
  EXPECT_FALSE(Tracker::create({.lidar_delay_s = 0.2}, rig).has_value());  // out of range
}

}  // namespace
}  // namespace edgesplat::tracking
