// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/imu_sensor.hpp"

#include <cmath>

namespace edgesplat::simulate {

ImuSensor::ImuSensor(const Trajectory& trajectory, const ImuSensorConfig& config)
    : trajectory_(trajectory), config_(config) {
  if (!config_.noisy) return;
  NoiseStream noise(config_.seed, NoisePurpose::kImuBias, ~0ULL);
  gyro_bias_radps_ = config_.gyro_bias_sigma_radps * noise.gaussian3();
  accel_bias_mps2_ = config_.accel_bias_sigma_mps2 * noise.gaussian3();
}

ImuReading ImuSensor::read() {
  const sensor::ImuModel& model = config_.model;
  ImuReading reading;
  reading.time_s = static_cast<double>(next_) / model.rate_hz;
  const BodyState body = trajectory_.at(reading.time_s);
  const Eigen::Vector3d up(0.0, 0.0, kGravity_mps2);
  reading.gyro_radps = body.angular_velocity_radps;
  reading.accel_mps2 = body.world_from_body.rotation.conjugate() * (body.acceleration_mps2 + up);
  if (config_.noisy) {
    // Discrete deviations of continuous densities: white x sqrt(rate), walk x sqrt(step).
    const double white = std::sqrt(model.rate_hz);
    NoiseStream noise(config_.seed, NoisePurpose::kImuWhite, next_);
    reading.gyro_radps += gyro_bias_radps_ + model.gyro_noise_radps_per_sqrt_hz * white * noise.gaussian3();
    reading.accel_mps2 += accel_bias_mps2_ + model.accel_noise_mps2_per_sqrt_hz * white * noise.gaussian3();
    NoiseStream walk(config_.seed, NoisePurpose::kImuBias, next_);
    gyro_bias_radps_ += model.gyro_bias_walk_radps2_per_sqrt_hz / white * walk.gaussian3();
    accel_bias_mps2_ += model.accel_bias_walk_mps3_per_sqrt_hz / white * walk.gaussian3();
  }
  ++next_;
  return reading;
}

}  // namespace edgesplat::simulate
