// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// A drive that does not end, at the full rate of the sensors and with a picture a group: memory stays where
// it is and tracking stays ahead of time. EDGESPLAT_ENDLESS_MINUTES: 3, or 30 where it is labelled slow.
#include "common/metrics/process_usage.hpp"
#include "common/time/clock.hpp"
#include "robot/tracking/tracker.hpp"
#include "test/support/simulated_groups.hpp"
#include "tools/simulate/camera_render.hpp"
#include "tools/simulate/camera_sensor.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <vector>

namespace edgesplat::tracking {
namespace {

constexpr double kMinutes = EDGESPLAT_ENDLESS_MINUTES;
constexpr double kMegabyte = 1e6;

/// Rounds of a corridor of 50 m, or of 300 m where there is time for it. Memory grows while places are new.
const char* world_name() {
  return kMinutes > 10.0 ? "loop" : "corridor";
}
constexpr double kWarmUp_s = kMinutes > 10.0 ? 400.0 : 75.0;
/// The map of the pictures' points grows up to its bound even where no place is new: a low one, to be reached
/// before memory is watched.
constexpr int kVisualMap_mb = kMinutes > 10.0 ? 4 : 1;
/// Drawing pictures takes most of the test's time.
constexpr int kWidth_px = 160;

sensor::CameraMount camera() {
  sensor::CameraMount mount;
  mount.model.width_px = kWidth_px;
  mount.model.height_px = kWidth_px * 4 / 5;
  mount.model.fx_px = mount.model.fy_px = 0.65 * kWidth_px;
  mount.model.cx_px = 0.5 * (mount.model.width_px - 1);
  mount.model.cy_px = 0.5 * (mount.model.height_px - 1);
  // The camera looks ahead: its z is the body's x.
  Eigen::Matrix3d body_from_camera;
  body_from_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  mount.body_from_camera.rotation = Eigen::Quaterniond(body_from_camera);
  mount.body_from_camera.translation_m = {0.08, 0.0, 0.03};
  return mount;
}

/// Least-squares slope of samples in equal steps of a minute's share.
double slope_per_minute(const std::vector<double>& samples, double per_minute) {
  const auto n = static_cast<double>(samples.size());
  double sum = 0.0, weighted = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    sum += samples[i];
    weighted += samples[i] * (static_cast<double>(i) - 0.5 * (n - 1.0));
  }
  return per_minute * weighted / (n * (n * n - 1.0) / 12.0);
}

TEST(Endless, MemoryStaysAndTrackingIsAheadOfTime) {
  const auto world = simulate::World::create({.name = world_name()});
  ASSERT_TRUE(world.has_value()) << world.error().context;
  test::SimulatedDriveConfig config;
  config.trajectory.duration_s = 60.0 * kMinutes;
  test::SimulatedDrive drive(**world, config);
  sensor::Rig rig = drive.rig();
  rig.camera = camera();
  const simulate::CameraSensor exposure{simulate::CameraSensorConfig{}};
  auto tracker = Tracker::create({.visual_map_max_mb = kVisualMap_mb}, rig);
  ASSERT_TRUE(tracker.has_value()) << tracker.error().context;

  const SteadyClock clock;
  double tracked_s = 0.0, error_m = 0.0;
  std::vector<double> resident_mb;
  int groups = 0, off_track = 0;
  std::optional<geometry::RigidTransform> odom_from_world;
  while (auto group = drive.next()) {
    const double time_s = 0.1 * ++groups;
    const auto truth = drive.truth(group->end).world_from_body;
    const auto picture =
        simulate::render_picture(**world, {rig.camera->model, truth * rig.camera->body_from_camera, time_s});
    group->image = sync::GroupImage{std::make_shared<sensor::ImageRgb8>(exposure.expose(
                                        picture.full, static_cast<std::uint64_t>(groups), time_s)),
                                    static_cast<float>(exposure.exposure_s(time_s)), 0.0F,
                                    static_cast<std::uint32_t>(groups)};
    const HostTime before = clock.now();
    const auto tracked = (*tracker)->track(*group);
    tracked_s += to_seconds(clock.now() - before);
    ASSERT_TRUE(tracked.has_value()) << tracked.error().context;
    if (tracked->health.state == TrackingState::kInitialising) continue;
    if (!odom_from_world) odom_from_world = tracked->odom_from_body * truth.inverse();
    off_track += tracked->health.state == TrackingState::kTracking ? 0 : 1;
    error_m = (tracked->odom_from_body.translation_m - (*odom_from_world * truth).translation_m).norm();
    if (groups % 50 != 0) continue;
    const double resident = static_cast<double>(metrics::process_usage().rss_bytes) / kMegabyte;
    if (time_s > kWarmUp_s) resident_mb.push_back(resident);
    if (groups % 600 != 0) continue;
    const TrackingCounters counters = (*tracker)->counters();
    std::printf("%4.0f s  %6.1f MB, of which planes %.1f, visual points %.1f; %5.3f m off\n", time_s,
                resident, static_cast<double>(counters.map_bytes) / kMegabyte,
                static_cast<double>(counters.visual_map_bytes) / kMegabyte, error_m);
    std::fflush(stdout);
  }
  const double slope_mb = slope_per_minute(resident_mb, 12.0);
  const double peak_mb = static_cast<double>(metrics::process_usage().peak_rss_bytes) / kMegabyte;
  std::printf(
      "%.2f MB a minute, %.0f MB at most, %.1f times as fast as the sensors, %d groups not on track\n",
      slope_mb, peak_mb, 60.0 * kMinutes / tracked_s, off_track);
  RecordProperty("rss_slope_mb_per_min", std::to_string(slope_mb));
  RecordProperty("peak_rss_mb", std::to_string(peak_mb));
  RecordProperty("times_real_time", std::to_string(60.0 * kMinutes / tracked_s));
  EXPECT_LT(slope_mb, 1.0);
  EXPECT_LT(peak_mb, 1000.0);
  EXPECT_LT(tracked_s, 60.0 * kMinutes);
  EXPECT_GT((*tracker)->counters().visual_updates, groups / 2);
  EXPECT_LE(off_track, groups / 100);
  EXPECT_LT(error_m, 1.0);
}

}  // namespace
}  // namespace edgesplat::tracking
