// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace edgesplat::sync {

struct GroupPoint {
  Eigen::Vector3f p_in_lidar_m;  ///< in the frame of its LiDAR at the time of the ray
  float reflectivity;            ///< 0..1
  std::int32_t before_end_ns;    ///< how long before the group's end the ray was fired, >= 0
  std::uint8_t noise_class;      ///< 0 good, 1 medium confidence
  std::uint8_t unit = 0;         ///< which of the rig's LiDARs
};

struct GroupImu {
  HostTime stamp;
  Eigen::Vector3d gyro_radps;
  Eigen::Vector3d accel_mps2;
};

struct GroupImage {
  std::shared_ptr<const sensor::ImageRgb8> image;
  float exposure_s;
  float gain_db;
  std::uint32_t sequence;
};

/// What was measured in (begin, end], all in host time: the unit that tracking consumes, one pose each. With
/// a camera, `end` is the middle of an exposure (scan recombination, FAST-LIVO2 IV-B), so the pose at `end`
/// is the image's pose.
struct MeasureGroup {
  HostTime begin{};
  HostTime end{};
  std::vector<GroupPoint> points;  ///< of all LiDARs, oldest first; may be empty
  bool has_point_times = true;     ///< false: all points as if measured at `end`
  /// Oldest first: every sample in (begin, end], the last one at or before `begin` and the first one at or
  /// after `end`, so that the state can be integrated exactly to `end`. Empty where the rig has no IMU.
  std::vector<GroupImu> imu;
  std::optional<GroupImage> image;  ///< taken at `end`
};

}  // namespace edgesplat::sync
