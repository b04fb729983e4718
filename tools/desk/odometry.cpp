// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/odometry.hpp"

#include "robot/drivers/replay/replay_source.hpp"
#include "robot/sync/group_builder.hpp"
#include "robot/tracking/tracker.hpp"
#include "tools/desk/imu_csv.hpp"

#include <cmath>
#include <numbers>
#include <span>
#include <utility>

namespace edgesplat::desk {
namespace {

/// Feeds groups to the tracker and keeps what comes out.
class OdometryLoop {
 public:
  OdometryLoop(tracking::Tracker& tracker, ScanTiming timing, const Clock& clock)
      : tracker_(tracker), timing_(timing), clock_(clock) {}

  Status take(std::vector<sync::MeasureGroup> groups) {
    for (sync::MeasureGroup& group : groups) EDGESPLAT_TRY_STATUS(track(group));
    return {};
  }
  OdometryRun finish() && {
    const tracking::TrackingCounters counters = tracker_.counters();
    run_.groups = counters.groups;
    run_.coasted_groups = counters.coasted_groups;
    run_.map_bytes = counters.map_bytes;
    return std::move(run_);
  }

 private:
  Status track(sync::MeasureGroup& group) {
    if (timing_ == ScanTiming::kAzimuth && !group.has_point_times) set_azimuth_times(group);
    const HostTime begin = clock_.now();
    EDGESPLAT_TRY(const tracking::TrackedGroup tracked, tracker_.track(group));
    run_.track_ms.push_back(to_seconds(clock_.now() - begin) * 1e3);
    run_.health.push_back({tracked.stamp, tracked.health});
    if (tracked.health.state != tracking::TrackingState::kInitialising) {
      run_.poses.push_back({tracked.stamp, tracked.odom_from_body});
    }
    return {};
  }

  tracking::Tracker& tracker_;
  ScanTiming timing_;
  const Clock& clock_;
  OdometryRun run_;
};

sensor::Rig choose_rig(const OdometryJob& job, sensor::Rig rig) {
  if (replay::ReplaySource::is_scan_folder(job.lidar)) rig.camera.reset();  // groups end with the scans
  if (job.imu && !rig.imu) rig.imu = sensor::ImuModel{};
  if (job.mode == OdometryMode::kLidar) {
    rig.imu.reset();
    rig.camera.reset();
  }
  return rig;
}

}  // namespace

tracking::TrackingConfig default_tracking(const std::filesystem::path& lidar,
                                          const std::optional<replay::BagRig>& rig) {
  tracking::TrackingConfig config;
  const bool is_hdl64 = rig && rig->rig.lidar.name == "hdl64e";
  if (!is_hdl64 && !replay::ReplaySource::is_scan_folder(lidar)) return config;
  config.root_voxel_m = 2.0;
  config.scan_voxel_m = 0.5;
  config.map_voxel_m = 0.25;
  return config;
}

void set_azimuth_times(sync::MeasureGroup& group) {
  const auto turn_ns = static_cast<double>((group.end - group.begin).count());
  for (sync::GroupPoint& point : group.points) {
    const double azimuth = std::atan2(point.p_in_lidar_m.y(), point.p_in_lidar_m.x());
    const double share_left = (azimuth + std::numbers::pi) / (2.0 * std::numbers::pi);
    point.before_end_ns = static_cast<std::int32_t>(share_left * turn_ns);
  }
  group.has_point_times = true;
}

Result<OdometryRun> run_odometry(const OdometryJob& job, const Clock& clock) {
  EDGESPLAT_TRY(replay::ReplaySource source, replay::ReplaySource::open(job.lidar, job.rig));
  const sensor::Rig rig = choose_rig(job, source.rig());
  std::vector<sensor::ImuSample> imu;
  if (job.imu) {
    EDGESPLAT_TRY(imu, read_imu_csv(*job.imu));
  }
  tracking::TrackingConfig config = job.tracking;
  config.visual = config.visual && job.mode == OdometryMode::kLidarInertialVisual;
  EDGESPLAT_TRY(const auto tracker, tracking::Tracker::create(config, rig));
  sync::GroupBuilder builder({}, rig);
  OdometryLoop loop(*tracker, job.timing, clock);
  std::span<const sensor::ImuSample> waiting = imu;
  while (true) {
    EDGESPLAT_TRY(auto measurement, source.next());
    if (!measurement) break;
    for (; !waiting.empty() && waiting.front().arrival <= sensor::arrival_of(*measurement);
         waiting = waiting.subspan(1)) {
      EDGESPLAT_TRY_STATUS(loop.take(builder.push(waiting.front())));
    }
    EDGESPLAT_TRY_STATUS(loop.take(builder.push(*std::move(measurement))));
  }
  if (!waiting.empty()) EDGESPLAT_TRY_STATUS(loop.take(builder.push(waiting.front())));
  EDGESPLAT_TRY_STATUS(loop.take(builder.flush()));
  OdometryRun run = std::move(loop).finish();
  if (run.poses.empty()) {
    return fail(Errc::kInvalidArgument, job.lidar.string() +
                                            " gave no pose: it holds too few points or too short an "
                                            "IMU record to start from");
  }
  return run;
}

}  // namespace edgesplat::desk
