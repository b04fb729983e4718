// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/tracker.hpp"

#include "test/support/simulated_groups.hpp"
#include "test/support/trajectory_error.hpp"
#include "test/tools/simulate/box_world.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <memory>

namespace edgesplat::tracking {
namespace {

const simulate::BoxWorld kRoom;

test::SimulatedDriveConfig drive_config(bool with_imu, double duration_s = 12.0) {
  test::SimulatedDriveConfig config;
  config.trajectory.duration_s = duration_s;
  config.with_imu = with_imu;
  config.keep_every_packet = 4;
  return config;
}

std::unique_ptr<Tracker> make_tracker(const sensor::Rig& rig, TrackingConfig config = {}) {
  auto tracker = Tracker::create(config, rig);
  EXPECT_TRUE(tracker.has_value()) << tracker.error().context;
  return *std::move(tracker);
}

struct Errors {
  double ate_m = 0.0;  ///< after alignment
  double end_m = 0.0;  ///< aligned at the first pose only
  int poses = 0;
  int coasted = 0;
};

/// Drives to the end, leaving out the first groups.
Errors drive(const test::SimulatedDriveConfig& config, int skipped_groups = 0) {
  test::SimulatedDrive source(kRoom, config);
  const auto tracker = make_tracker(source.rig());
  Errors errors;
  std::vector<Eigen::Vector3d> estimate, truth;
  std::optional<geometry::RigidTransform> odom_from_world;
  for (int i = 0; auto group = source.next(); ++i) {
    if (i < skipped_groups) continue;
    const auto tracked = tracker->track(*group);
    EXPECT_TRUE(tracked.has_value());
    if (tracked->health.state == TrackingState::kInitialising) continue;
    const auto world_from_body = source.truth(tracked->stamp).world_from_body;
    if (!odom_from_world) odom_from_world = tracked->odom_from_body * world_from_body.inverse();
    estimate.push_back(tracked->odom_from_body.translation_m);
    truth.push_back((*odom_from_world * world_from_body).translation_m);
    errors.end_m = (estimate.back() - truth.back()).norm();
    errors.coasted += tracked->health.state == TrackingState::kCoasting ? 1 : 0;
  }
  errors.poses = static_cast<int>(estimate.size());
  errors.ate_m = test::absolute_error_m(estimate, truth);
  return errors;
}

TEST(Tracker, DrivesThroughARoomWithImu) {
  const Errors errors = drive(drive_config(true));
  EXPECT_LT(errors.ate_m, 0.01);
  EXPECT_LT(errors.end_m, 0.05);
  EXPECT_GE(errors.poses, 115);
  EXPECT_EQ(errors.coasted, 0);
}

TEST(Tracker, DrivesThroughARoomWithoutImu) {
  const Errors errors = drive(drive_config(false));
  EXPECT_LT(errors.ate_m, 0.015);
  EXPECT_LT(errors.end_m, 0.05);
  EXPECT_EQ(errors.poses, 119);  // the first sweep only begins the map: its speed is not known yet
}

TEST(Tracker, StartsInMotion) {
  EXPECT_LT(drive(drive_config(true), 40).ate_m, 0.015);
  EXPECT_LT(drive(drive_config(false), 40).ate_m, 0.02);
}

TEST(Tracker, OneAndTwoThreadsGiveTheSameBits) {
  for (const bool with_imu : {true, false}) {
    test::SimulatedDrive source(kRoom, drive_config(with_imu, 4.0));
    TrackingConfig two_threads;
    two_threads.threads = 2;
    const auto one = make_tracker(source.rig());
    const auto two = make_tracker(source.rig(), two_threads);
    while (auto group = source.next()) {
      const auto a = one->track(*group);
      const auto b = two->track(*group);
      ASSERT_TRUE(a.has_value() && b.has_value());
      EXPECT_EQ(a->odom_from_body.matrix(), b->odom_from_body.matrix());
      EXPECT_EQ(a->pose_covariance, b->pose_covariance);
      ASSERT_EQ(a->points_in_body.size(), b->points_in_body.size());
      for (std::size_t i = 0; i < a->points_in_body.size(); ++i) {
        ASSERT_EQ(a->points_in_body[i].p_in_body_m, b->points_in_body[i].p_in_body_m);
      }
    }
  }
}

TEST(Tracker, DeskewedPointsLieOnTheWalls) {
  auto config = drive_config(true, 6.0);
  config.noisy = false;
  test::SimulatedDrive source(kRoom, config);
  const auto tracker = make_tracker(source.rig());
  TrackedGroup last;
  while (auto group = source.next()) last = *tracker->track(*group);
  const auto world_from_body = source.truth(last.stamp).world_from_body;
  ASSERT_GT(last.points_in_body.size(), 1000U);
  for (const DeskewedPoint& point : last.points_in_body) {
    const Eigen::Vector3d p = world_from_body * point.p_in_body_m.cast<double>();
    const double off = std::min({std::abs(std::abs(p.x()) - 10.0), std::abs(std::abs(p.y()) - 8.0),
                                 std::abs(p.z()), std::abs(p.z() - 4.0)});
    ASSERT_LT(off, 0.02);
  }
}

TEST(Tracker, CoastsThroughGroupsWithoutPointsAndRecovers) {
  test::SimulatedDrive source(kRoom, drive_config(true, 8.0));
  const auto tracker = make_tracker(source.rig());
  std::optional<geometry::RigidTransform> odom_from_world;
  for (int i = 0; auto group = source.next(); ++i) {
    const bool blind = i >= 50 && i < 60;
    if (blind) group->points.clear();
    const auto tracked = tracker->track(*group);
    ASSERT_TRUE(tracked.has_value());
    if (tracked->health.state == TrackingState::kInitialising) continue;
    EXPECT_EQ(tracked->health.state, blind ? TrackingState::kCoasting : TrackingState::kTracking) << i;
    const auto truth = source.truth(tracked->stamp).world_from_body;
    if (!odom_from_world) odom_from_world = tracked->odom_from_body * truth.inverse();
    const double error =
        (tracked->odom_from_body.translation_m - (*odom_from_world * truth).translation_m).norm();
    EXPECT_LT(error, blind ? 0.2 : 0.05) << i;
  }
  EXPECT_EQ(tracker->counters().coasted_groups, 10);
}

TEST(Tracker, SurvivesAnImuThatFallsSilent) {
  test::SimulatedDrive source(kRoom, drive_config(true, 8.0));
  const auto tracker = make_tracker(source.rig());
  for (int i = 0; auto group = source.next(); ++i) {
    if (i >= 50 && i < 53) group->imu.clear();
    const auto tracked = tracker->track(*group);
    ASSERT_TRUE(tracked.has_value());
    if (i > 10) {
      EXPECT_EQ(tracked->health.state, TrackingState::kTracking) << i;
    }
  }
  EXPECT_EQ(tracker->counters().imu_gaps, 3);
}

TEST(Tracker, CountsBadInputAndGoesOn) {
  test::SimulatedDrive source(kRoom, drive_config(true, 3.0));
  const auto tracker = make_tracker(source.rig());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  TrackedGroup last;
  while (auto group = source.next()) {
    group->points.push_back({Eigen::Vector3f(nan, 1, 1), 0.5F, 0, 0});
    group->points.push_back({Eigen::Vector3f(0.01F, 0, 0), 0.5F, 0, 0});
    group->points.push_back({Eigen::Vector3f(1e20F, 0, 0), 0.5F, 0, 0});
    group->imu.push_back(group->imu.back());
    group->imu.push_back(group->imu.back());
    group->imu.back().stamp += std::chrono::milliseconds(1);
    group->imu.back().accel_mps2.x() = std::numeric_limits<double>::infinity();
    last = *tracker->track(*group);
  }
  EXPECT_EQ(last.health.state, TrackingState::kTracking);
  EXPECT_EQ(tracker->counters().bad_points, 30);
  EXPECT_EQ(tracker->counters().out_of_range_points, 60);
  EXPECT_EQ(tracker->counters().bad_imu_samples, 60);
}

TEST(Tracker, RefusesGroupsOutOfOrder) {
  test::SimulatedDrive source(kRoom, drive_config(false, 1.0));
  const auto tracker = make_tracker(source.rig());
  const auto first = *source.next();
  const auto second = *source.next();
  ASSERT_TRUE(tracker->track(second).has_value());
  const auto refused = tracker->track(first);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, Errc::kInvalidArgument);
  EXPECT_FALSE(tracker->track(second).has_value());
  sync::MeasureGroup backwards = *source.next();
  std::swap(backwards.begin, backwards.end);
  EXPECT_FALSE(tracker->track(backwards).has_value());
  EXPECT_TRUE(tracker->track(*source.next()).has_value());
}

TEST(Tracker, RunsOnNothingButEmptyGroups) {
  const auto tracker = make_tracker(sensor::Rig{});
  for (int i = 1; i <= 5; ++i) {
    sync::MeasureGroup group;
    group.begin = HostTime(from_seconds(0.1 * (i - 1)));
    group.end = HostTime(from_seconds(0.1 * i));
    const auto tracked = tracker->track(group);
    ASSERT_TRUE(tracked.has_value());
    EXPECT_TRUE(tracked->odom_from_body.is_finite());
    EXPECT_TRUE(tracked->points_in_body.empty());
  }
}

TEST(Tracker, RefusesAConfigurationOutOfRange) {
  TrackingConfig config;
  config.root_voxel_m = 0.0;
  config.max_layer = 9;
  const auto tracker = Tracker::create(config, sensor::Rig{});
  ASSERT_FALSE(tracker.has_value());
  EXPECT_EQ(tracker.error().code, Errc::kInvalidConfig);
  EXPECT_NE(tracker.error().context.find("root_voxel_m"), std::string::npos);
  EXPECT_NE(tracker.error().context.find("max_layer"), std::string::npos);
  sensor::Rig blind;
  blind.lidar.range_sigma_m = 0.0;
  EXPECT_FALSE(Tracker::create({}, blind).has_value());
}

class NoMap : public GaussianView {
 public:
  std::optional<GaussianPicture> draw(const geometry::CameraModel&,
                                      const geometry::RigidTransform&) override {
    ++asked;
    return std::nullopt;
  }
  int asked = 0;
};

/// Drives with pictures that show nothing; the last pose.
geometry::RigidTransform drive_with_view(int every, const std::shared_ptr<NoMap>& view,
                                         TrackingCounters& counters) {
  test::SimulatedDrive source(kRoom, drive_config(true, 4.0));
  sensor::Rig rig = source.rig();
  rig.camera.emplace();
  rig.camera->model = {geometry::CameraKind::kPinhole, 160, 128, 80.0, 80.0, 79.5, 63.5, {}};
  TrackingConfig config;
  config.gaussian_every = every;
  const auto tracker = make_tracker(rig, config);
  tracker->look_at(view);
  geometry::RigidTransform last;
  while (auto group = source.next()) {
    group->image =
        sync::GroupImage{std::make_shared<sensor::ImageRgb8>(160, 128, std::uint8_t{90}), 0.0F, 0.0F, 0};
    const auto tracked = tracker->track(*group);
    EXPECT_TRUE(tracked.has_value());
    last = tracked->odom_from_body;
  }
  counters = tracker->counters();
  return last;
}

TEST(Tracker, LooksAtTheGaussianMapOnlyWhereAskedTo) {
  TrackingCounters never, every_third, without_view;
  const auto view = std::make_shared<NoMap>();
  const auto pose = drive_with_view(0, view, never);
  EXPECT_EQ(view->asked, 0);
  EXPECT_EQ(never.gaussian_looks, 0);
  // A map that is not there yet changes nothing.
  EXPECT_EQ(drive_with_view(3, view, every_third).matrix(), pose.matrix());
  EXPECT_GT(every_third.gaussian_looks, 10);
  EXPECT_LE(every_third.gaussian_looks, every_third.groups / 3);
  EXPECT_EQ(view->asked, every_third.gaussian_looks);
  EXPECT_EQ(every_third.gaussian_updates, 0);
  EXPECT_EQ(drive_with_view(3, nullptr, without_view).matrix(), pose.matrix());
  EXPECT_EQ(without_view.gaussian_looks, 0);
}

}  // namespace
}  // namespace edgesplat::tracking
