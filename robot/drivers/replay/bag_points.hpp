// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/io/ros_sensor_messages.hpp"
#include "common/sensor/measurement.hpp"
#include "robot/drivers/replay/bag_rig.hpp"

#include <cstdint>
#include <optional>

namespace edgesplat::replay {

/// What the tags of a Livox CustomMsg mean: those of livox_ros_driver are SDK1's, of livox_ros_driver2
/// SDK2's.
enum class LivoxTags : std::uint8_t { kSdk1, kSdk2 };

/// Points of ROS messages to what the drivers deliver: a LidarPacket whose points have the times of their
/// rays, in firing order, or a LidarScan where the message tells no times. Returns only: points that are not
/// finite, at 0, 0, 0, or that a Livox itself calls noise are dropped and counted. Single-owner.
class BagPoints {
 public:
  explicit BagPoints(const BagSettings& settings) : settings_(settings) {}

  /// Nothing where no point is left. kCorrupt where a sweep would last over a second.
  [[nodiscard]] Result<std::optional<sensor::Measurement>> convert(const io::LivoxCustomMessage& message,
                                                                   LivoxTags tags, HostTime arrival);
  /// The same. Point times are found by name: t (Ouster), time (Velodyne), timestamp (Hesai, Robosense,
  /// Livox), offset_time; times of day are taken relative to the header's stamp where they lie within a
  /// second of it, else as times after it. kCorrupt, too, where there is no x, y or z.
  [[nodiscard]] Result<std::optional<sensor::Measurement>> convert(const io::RosPointCloud& cloud,
                                                                   HostTime arrival);
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  struct TimedPoint {
    std::int64_t t_ns;  ///< after the header's stamp
    sensor::LidarPoint point;
  };
  struct Columns;
  [[nodiscard]] bool keep(const Eigen::Vector3f& p_m);
  [[nodiscard]] Result<std::optional<sensor::Measurement>> packet(SensorTime header_stamp, HostTime arrival,
                                                                  std::vector<TimedPoint> points) const;
  /// The times of the points that are left, raw in `times`, as ns after the header's stamp.
  void set_times(std::vector<TimedPoint>& points, const std::vector<double>& times, bool whole_numbers,
                 SensorTime header_stamp);

  BagSettings settings_;
  std::optional<double> ns_per_unit_;  ///< decided with the first cloud
  std::uint64_t dropped_ = 0;
};

}  // namespace edgesplat::replay
