// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/device_clock.hpp"
#include "tools/simulate/imu_sensor.hpp"
#include "tools/simulate/lidar_sensor.hpp"
#include "tools/simulate/recording_writer.hpp"
#include "tools/simulate/simulate_options.hpp"
#include "tools/simulate/trajectory.hpp"

#include <cstddef>
#include <cstdint>

namespace edgesplat::simulate {

/// A Livox unit: LiDAR and IMU behind one clock, measuring into datagrams. Casts on all cores. Single-owner.
class VirtualLidar {
 public:
  /// `unit`: which of the robot's LiDARs; each has a clock of its own.
  VirtualLidar(const World& world, const Trajectory& trajectory, const SimulateOptions& options,
               std::size_t unit = 0);

  /// Everything measured before `end_s`, simulation time, since the last call. The true pose is recorded with
  /// each IMU sample. The IMUs of LiDARs other than the first are off.
  void measure_until(double end_s, RecordingWriter& recording);
  [[nodiscard]] std::uint64_t point_packets() const { return next_packet_; }
  [[nodiscard]] std::uint64_t imu_packets() const { return next_sample_; }

 private:
  void measure_points(double end_s, RecordingWriter& recording);
  void measure_inertia(double end_s, RecordingWriter& recording);
  const Trajectory& trajectory_;
  std::size_t unit_;
  double imu_rate_hz_;
  LidarPattern pattern_;
  LidarSensor lidar_;
  ImuSensor imu_;
  DeviceClock clock_;
  ArrivalModel point_arrival_;
  ArrivalModel imu_arrival_;
  std::uint64_t next_packet_ = 0;
  std::uint64_t next_sample_ = 0;
};

}  // namespace edgesplat::simulate
