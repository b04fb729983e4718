// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/sensor/rig.hpp"
#include "common/time/time.hpp"
#include "robot/sync/measure_group.hpp"
#include "robot/tracking/tracking_config.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace edgesplat::desk {

/// When the rays of a scan were fired.
enum class ScanTiming {
  kInstant,           ///< all at the scan's stamp
  kAzimuthClockwise,  ///< a spinning LiDAR's turn backwards -> left... seen from above, ending at the stamp
};

/// A folder of KITTI scans.
struct ScanFolder {
  std::vector<std::filesystem::path> files;  ///< *.bin in the order of their names
  std::vector<HostTime> stamps;              ///< one a file: times.txt, else 10 Hz from zero
};

/// Errors: kNotFound without a .bin file, kCorrupt where times.txt does not fit the files.
[[nodiscard]] Result<ScanFolder> open_scan_folder(const std::filesystem::path& folder);
/// Points of float32 x, y, z, intensity. kCorrupt where the length is no multiple of 16 bytes.
[[nodiscard]] Result<std::vector<sync::GroupPoint>> read_scan(const std::filesystem::path& file);
/// EuRoC's layout: t_ns, gyro x y z (rad/s), accelerometer x y z (m/s^2), commas; '#' and empty rows are skipped.
[[nodiscard]] Result<std::vector<sync::GroupImu>> read_imu_csv(const std::filesystem::path& file);
[[nodiscard]] Result<std::vector<sync::GroupImu>> parse_imu_csv(std::string_view text, std::string_view name);
/// The samples that belong to a group: see MeasureGroup::imu.
[[nodiscard]] std::vector<sync::GroupImu> imu_between(std::span<const sync::GroupImu> imu, HostTime begin,
                                                      HostTime end);
/// Gives every point the time its azimuth tells, for a turn that ends at the stamp.
void set_azimuth_times(std::span<sync::GroupPoint> points, nanoseconds turn);

struct OdometryJob {
  std::filesystem::path lidar_folder;
  std::optional<std::filesystem::path> imu_file;
  sensor::Rig rig;
  tracking::TrackingConfig tracking;
  ScanTiming timing = ScanTiming::kInstant;
};

struct OdometryRun {
  std::vector<HostTime> stamps;
  std::vector<geometry::RigidTransform> odom_from_body;  ///< scans before the first pose are left out
  std::vector<double> track_ms;                          ///< time in track(), one a scan
  std::size_t scans = 0;
  std::size_t coasted = 0;
};

/// Tracks every scan of a folder. `clock` times the stages.
[[nodiscard]] Result<OdometryRun> run_odometry(const OdometryJob& job, const Clock& clock);

}  // namespace edgesplat::desk
