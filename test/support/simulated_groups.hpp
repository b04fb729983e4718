// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/rig.hpp"
#include "robot/sync/measure_group.hpp"
#include "tools/simulate/imu_sensor.hpp"
#include "tools/simulate/lidar_sensor.hpp"
#include "tools/simulate/trajectory.hpp"
#include "tools/simulate/world.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace edgesplat::test {

struct SimulatedDriveConfig {
  simulate::TrajectoryConfig trajectory;
  double group_s = 0.1;
  bool with_imu = true;
  bool noisy = true;
  std::uint64_t keep_every_packet = 1;   ///< thins the points: 1 keeps all 200 000 points/s
  double lidar_stamp_error_s = 0.0;      ///< added to the stamps of rays
  geometry::RigidTransform lidar_error;  ///< the rig's body_from_lidar is this times the true one
  std::uint64_t seed = 1;
  std::vector<sensor::LidarMount> more_lidars;  ///< Mid-360s as well
};

/// A Mid-360 with its IMU on a body that drives through a world: groups as robot/sync cuts them, with perfect
/// clocks, made one at a time. The world outlives it.
class SimulatedDrive {
 public:
  SimulatedDrive(const simulate::World& world, const SimulatedDriveConfig& config);

  [[nodiscard]] const sensor::Rig& rig() const { return rig_; }
  /// The next group; nothing after the trajectory's end.
  std::optional<sync::MeasureGroup> next();
  /// Where the body truly was.
  [[nodiscard]] simulate::BodyState truth(HostTime stamp) const;

 private:
  void add_points(sync::MeasureGroup& group, double begin_s, double end_s, std::size_t unit) const;
  void add_imu(sync::MeasureGroup& group, double begin_s, double end_s);

  SimulatedDriveConfig config_;
  sensor::Rig rig_;
  simulate::Trajectory trajectory_;
  std::vector<simulate::LidarSensor> lidars_;
  simulate::ImuSensor imu_;
  std::vector<simulate::ImuReading> readings_;
  int group_ = 0;
};

}  // namespace edgesplat::test
