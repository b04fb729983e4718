// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/rig.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace edgesplat::config {
class ConfigReader;
}

namespace edgesplat::replay {

enum class StampClock : std::uint8_t {
  kHeader,   ///< the sensors' clocks agree: header stamps are taken as they are
  kArrival,  ///< each sensor has a clock of its own: fitted to the times of recording
};
enum class AccelUnit : std::uint8_t { kAuto, kMps2, kG };
enum class PointTimeUnit : std::uint8_t { kAuto, kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };

/// What a ROS recording of a rig does not say itself; [replay] of rig.toml.
struct BagSettings {
  std::string lidar_topic;  ///< empty: the only one of its type
  std::string imu_topic;
  std::string image_topic;
  StampClock clock = StampClock::kHeader;
  double lidar_stamp_offset_s = 0.0;  ///< added to the stamps of points, [-10, 10]
  double imu_stamp_offset_s = 0.0;    ///< added to the stamps of IMU samples, [-10, 10]
  AccelUnit imu_accel_unit = AccelUnit::kAuto;
  PointTimeUnit point_time_unit = PointTimeUnit::kAuto;
  double full_intensity = 255.0;  ///< intensity of a PointCloud2 that is reflectivity 1, [1e-3, 1e6]
};

/// A rig with what is needed to read ROS recordings of it.
struct BagRig {
  sensor::Rig rig;
  BagSettings replay;
};

/// The fields of rig.toml, with the optional [replay].
void describe(config::ConfigReader& reader, BagRig& rig);
/// kInvalidConfig with every problem; kNotFound or kIo where it cannot be read.
[[nodiscard]] Result<BagRig> load_bag_rig(const std::filesystem::path& path);
[[nodiscard]] Result<BagRig> parse_bag_rig(std::string_view text, std::string name);

}  // namespace edgesplat::replay
