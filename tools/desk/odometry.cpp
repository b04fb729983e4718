// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/odometry.hpp"

#include "common/geometry/rigid_transform.hpp"
#include "robot/drivers/replay/replay_source.hpp"
#include "robot/sync/group_builder.hpp"
#include "robot/tracking/tracker.hpp"
#include "tools/desk/imu_csv.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <system_error>
#include <utility>

namespace edgesplat::desk {
namespace {

/// KITTI's HDL-64E turns ten times a second.
constexpr nanoseconds kHalfTurn = std::chrono::milliseconds(50);

/// Feeds groups to the tracker and keeps what comes out.
class OdometryLoop {
 public:
  OdometryLoop(tracking::Tracker& tracker, const OdometryJob& job, const Clock& clock, const Clock& processor)
      : tracker_(tracker),
        timing_(job.timing),
        with_imu_(job.imu.has_value()),
        clock_(clock),
        processor_(processor) {}

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
    const HostTime begin_cpu = processor_.now();
    EDGESPLAT_TRY(const tracking::TrackedGroup tracked, tracker_.track(group));
    run_.track_cpu_ms.push_back(to_seconds(processor_.now() - begin_cpu) * 1e3);
    run_.track_ms.push_back(to_seconds(clock_.now() - begin) * 1e3);
    run_.health.push_back({tracked.stamp, tracked.health});
    if (timing_ == ScanTiming::kAzimuth) {
      add_pose_of_turn(tracked);
    } else if (tracked.health.state != tracking::TrackingState::kInitialising) {
      run_.poses.push_back({tracked.stamp, tracked.odom_from_body});
    }
    return {};
  }

  /// A turn's stamp is its middle, and tracking tells the pose at its end. Without an IMU the first turn's
  /// middle is where odom begins.
  void add_pose_of_turn(const tracking::TrackedGroup& tracked) {
    const HostTime stamp = tracked.stamp - kHalfTurn;
    if (tracked.health.state == tracking::TrackingState::kInitialising) {
      if (!with_imu_) run_.poses.push_back({stamp, tracked.odom_from_body});
      before_ = {stamp, tracked.odom_from_body};
      return;
    }
    if (before_ && before_->stamp < stamp) {
      const double share = to_seconds(stamp - before_->stamp) / to_seconds(tracked.stamp - before_->stamp);
      run_.poses.push_back(
          {stamp, geometry::interpolate(before_->world_from_body, tracked.odom_from_body, share)});
    }
    before_ = {tracked.stamp, tracked.odom_from_body};
  }

  tracking::Tracker& tracker_;
  ScanTiming timing_;
  bool with_imu_;
  std::optional<io::StampedPose> before_;  ///< the last pose known, of turns
  const Clock& clock_;
  const Clock& processor_;
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

ScanTiming timing_of(const std::filesystem::path& lidar) {
  if (!replay::ReplaySource::is_scan_folder(lidar)) return ScanTiming::kInstant;
  std::error_code error;
  for (const auto& place : {lidar / "velodyne", lidar}) {
    for (std::filesystem::directory_iterator at(place, error), end; !error && at != end;
         at.increment(error)) {
      if (at->path().extension() != ".bin") continue;
      const std::string stem = at->path().stem().string();
      const bool number = std::ranges::all_of(stem, [](char c) { return c >= '0' && c <= '9'; });
      return number && stem.size() == 10 ? ScanTiming::kAzimuth : ScanTiming::kInstant;
    }
  }
  return ScanTiming::kInstant;
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

Result<OdometryRun> run_odometry(const OdometryJob& asked, const Clock& clock, const Clock& processor) {
  OdometryJob job = asked;
  if (job.timing == ScanTiming::kAuto) job.timing = timing_of(job.lidar);
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
  OdometryLoop loop(*tracker, job, clock, processor);
  std::span<const sensor::ImuSample> waiting = imu;
  std::optional<HostTime> first;
  while (true) {
    EDGESPLAT_TRY(auto measurement, source.next());
    if (!measurement) break;
    const HostTime arrival = sensor::arrival_of(*measurement);
    if (!first) first = arrival;
    if (arrival - *first < from_seconds(job.from_s)) continue;
    if (auto* scan = std::get_if<sensor::LidarScan>(&*measurement);
        scan != nullptr && job.timing == ScanTiming::kAzimuth) {
      scan->stamp += kHalfTurn;
      scan->arrival += kHalfTurn;
    }
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
