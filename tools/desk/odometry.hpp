// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/io/trajectory_file.hpp"
#include "common/sensor/rig.hpp"
#include "common/time/clock.hpp"
#include "robot/drivers/replay/bag_rig.hpp"
#include "robot/sync/measure_group.hpp"
#include "robot/tracking/tracked_group.hpp"
#include "robot/tracking/tracking_config.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace edgesplat::desk {

/// When the rays of a whole scan were fired.
enum class ScanTiming : std::uint8_t {
  kAuto,     ///< as a folder's layout says: see timing_of()
  kInstant,  ///< all at the scan's stamp: scans whose motion was already removed, or a slow robot
  kAzimuth,  ///< in one turn of 0.1 s around the stamp, clockwise seen from above, from behind to behind: an
             ///< HDL-64E on KITTI's car, whose stamps say when it looks forward
};

/// Which sensors the pose comes from.
enum class OdometryMode : std::uint8_t {
  kLidarInertialVisual,  ///< everything that the rig has
  kLidarInertial,        ///< pictures only say when groups end
  kLidar,
};

struct OdometryJob {
  std::filesystem::path lidar;               ///< a folder of KITTI .bin scans, or a recording
  std::optional<std::filesystem::path> imu;  ///< EuRoC's CSV, on the scans' time base
  std::optional<replay::BagRig> rig;         ///< instead of the recording's own; needed for one of ROS
  tracking::TrackingConfig tracking;
  ScanTiming timing = ScanTiming::kInstant;
  OdometryMode mode = OdometryMode::kLidarInertialVisual;
  double from_s = 0.0;  ///< left out at the recording's begin, by arrival
};

struct OdometryRun {
  std::vector<io::StampedPose> poses;  ///< odom_from_body, one a group once the first pose is known
  std::vector<double> track_ms;        ///< time in Tracker::track, one a group
  std::vector<double> track_cpu_ms;    ///< processor time there
  struct GroupHealth {
    HostTime stamp{};
    tracking::TrackingHealth health;
  };
  std::vector<GroupHealth> health;  ///< one a group
  std::int64_t groups = 0;
  std::int64_t coasted_groups = 0;
  std::int64_t map_bytes = 0;
};

/// The defaults of tracking for a job: cells and thinning for streets where the LiDAR is a 64-line one (a
/// folder of scans, or a rig that names a "hdl64e"), those of TrackingConfig for a recording.
[[nodiscard]] tracking::TrackingConfig default_tracking(const std::filesystem::path& lidar,
                                                        const std::optional<replay::BagRig>& rig = {});

/// Tracks a whole recording, as fast as it goes. The clocks time the groups: `processor` shows what the
/// process spent. Errors of reading, and kInvalidArgument where nothing in it could be tracked.
[[nodiscard]] Result<OdometryRun> run_odometry(const OdometryJob& job, const Clock& clock,
                                               const Clock& processor);

/// kAzimuth for a folder of KITTI's raw scans, which are stored as they were fired: their names have ten
/// digits. Everything else counts as kInstant: the scans of KITTI's odometry benchmark (six digits) were
/// turned into those of one moment, and recordings bring the times of their points.
[[nodiscard]] ScanTiming timing_of(const std::filesystem::path& lidar);

/// Gives every point of a group the time that its azimuth tells for kAzimuth.
void set_azimuth_times(sync::MeasureGroup& group);

}  // namespace edgesplat::desk
