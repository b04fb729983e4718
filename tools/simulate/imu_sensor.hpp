// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/rig.hpp"
#include "tools/simulate/noise.hpp"
#include "tools/simulate/trajectory.hpp"

#include <Eigen/Core>

#include <cstdint>

namespace edgesplat::simulate {

inline constexpr double kGravity_mps2 = 9.81;

struct ImuSensorConfig {
  sensor::ImuModel model;                ///< noise densities and rate
  double gyro_bias_sigma_radps = 0.003;  ///< spread of the bias at power-on
  double accel_bias_sigma_mps2 = 0.03;
  bool noisy = true;  ///< false: the exact values, for tests
  std::uint64_t seed = 1;
};

struct ImuReading {
  double time_s = 0.0;  ///< simulation time
  Eigen::Vector3d gyro_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_mps2 = Eigen::Vector3d::Zero();  ///< specific force: +g on z at rest
};

/// An inertial sensor at the body's origin: exact rates and specific force of the trajectory + a random-walk
/// bias + white noise. Sample k is taken at k / rate. Single-owner.
class ImuSensor {
 public:
  ImuSensor(const Trajectory& trajectory, const ImuSensorConfig& config);
  /// The next sample.
  ImuReading read();

 private:
  const Trajectory& trajectory_;
  ImuSensorConfig config_;
  std::uint64_t next_ = 0;
  Eigen::Vector3d gyro_bias_radps_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_mps2_ = Eigen::Vector3d::Zero();
};

}  // namespace edgesplat::simulate
