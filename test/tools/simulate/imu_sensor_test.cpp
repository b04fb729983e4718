// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/imu_sensor.hpp"

#include "common/geometry/so3.hpp"
#include "test/tools/simulate/box_world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace edgesplat::simulate {
namespace {

Trajectory drive_for(double duration_s) {
  TrajectoryConfig config;
  config.duration_s = duration_s;
  return *Trajectory::create(BoxWorld().path(), config);
}

// A robot that never starts: what is left of the readings is gravity, bias and noise.
Trajectory stand_for(double duration_s) {
  TrajectoryConfig config;
  config.duration_s = duration_s;
  config.standstill_s = 1e9;
  return *Trajectory::create(BoxWorld().path(), config);
}

// Overlapping Allan deviation of a rate signal at cluster time m / rate.
double allan_deviation(const std::vector<double>& rate, std::size_t m) {
  std::vector<double> sum(rate.size() + 1, 0.0);
  for (std::size_t i = 0; i < rate.size(); ++i) sum[i + 1] = sum[i] + rate[i];
  double total = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + 2 * m < sum.size(); ++i, ++count) {
    const double d = (sum[i + 2 * m] - 2.0 * sum[i + m] + sum[i]) / static_cast<double>(m);
    total += d * d;
  }
  return std::sqrt(total / (2.0 * static_cast<double>(count)));
}

TEST(ImuSensor, ExactReadingsIntegrateBackToTheTrajectory) {
  const Trajectory trajectory = drive_for(12.0);
  ImuSensorConfig config;
  config.noisy = false;
  config.model.rate_hz = 1000.0;  // the integrator's own error, not the sensor's, shows at 200 Hz
  ImuSensor imu(trajectory, config);
  const double step_s = 1.0 / config.model.rate_hz;
  Eigen::Quaterniond rotation = trajectory.at(0.0).world_from_body.rotation;
  Eigen::Vector3d position_m = trajectory.at(0.0).world_from_body.translation_m;
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
  const Eigen::Vector3d gravity(0, 0, -kGravity_mps2);
  ImuReading last = imu.read();
  for (int k = 0; k < 10000; ++k) {
    const ImuReading next = imu.read();
    const Eigen::Vector3d first_mps2 = rotation * last.accel_mps2 + gravity;
    rotation = rotation * geometry::so3_exp(0.5 * step_s * (last.gyro_radps + next.gyro_radps));
    const Eigen::Vector3d second_mps2 = rotation * next.accel_mps2 + gravity;
    position_m += step_s * velocity_mps + step_s * step_s * (2.0 * first_mps2 + second_mps2) / 6.0;
    velocity_mps += 0.5 * step_s * (first_mps2 + second_mps2);
    last = next;
  }
  EXPECT_NEAR(last.time_s, 10.0, 1e-9);
  const auto truth = trajectory.world_from_body(10.0);
  EXPECT_GT((truth.translation_m - trajectory.world_from_body(0.0).translation_m).norm(), 5.0);
  EXPECT_LT((position_m - truth.translation_m).norm(), 1e-3);
  EXPECT_LT(rotation.angularDistance(truth.rotation), 1e-4);
}

TEST(ImuSensor, FeelsGravityAtRest) {
  const Trajectory trajectory = stand_for(1.0);
  ImuSensorConfig config;
  config.noisy = false;
  const ImuReading reading = ImuSensor(trajectory, config).read();
  EXPECT_NEAR(reading.accel_mps2.norm(), kGravity_mps2, 1e-9);
  EXPECT_GT(reading.accel_mps2.z(), 9.8);
  EXPECT_LT(reading.gyro_radps.norm(), 1e-12);
}

TEST(ImuSensor, AllanDeviationMatchesTheDensities) {
  const Trajectory trajectory = stand_for(300.0);
  ImuSensorConfig config;
  ImuSensor imu(trajectory, config);
  std::vector<double> gyro, accel;
  for (int k = 0; k < 200 * 300; ++k) {
    const ImuReading reading = imu.read();
    gyro.push_back(reading.gyro_radps.x());
    accel.push_back(reading.accel_mps2.y());
  }
  // White noise of density N has deviation N / sqrt(tau); clusters of 0.1 s and of 1 s.
  for (const std::size_t m : {20UL, 200UL}) {
    const double tau_s = static_cast<double>(m) / 200.0;
    const double gyro_density = allan_deviation(gyro, m) * std::sqrt(tau_s);
    const double accel_density = allan_deviation(accel, m) * std::sqrt(tau_s);
    EXPECT_NEAR(gyro_density, config.model.gyro_noise_radps_per_sqrt_hz, 2e-4) << tau_s;
    EXPECT_NEAR(accel_density, config.model.accel_noise_mps2_per_sqrt_hz, 2e-3) << tau_s;
  }
}

TEST(ImuSensor, BiasWalksAsItsDensitySays) {
  const Trajectory trajectory = stand_for(1.0);
  ImuSensorConfig config;
  config.model.gyro_noise_radps_per_sqrt_hz = 0.0;
  config.gyro_bias_sigma_radps = 0.0;
  double square = 0.0;
  constexpr int kRuns = 200, kSamples = 2000;  // 10 s each
  for (int run = 0; run < kRuns; ++run) {
    config.seed = static_cast<std::uint64_t>(run);
    ImuSensor imu(trajectory, config);
    ImuReading reading;
    for (int k = 0; k <= kSamples; ++k) reading = imu.read();
    square += reading.gyro_radps.squaredNorm() / 3.0;
  }
  const double expected = config.model.gyro_bias_walk_radps2_per_sqrt_hz * std::sqrt(kSamples / 200.0);
  EXPECT_NEAR(std::sqrt(square / kRuns), expected, 0.1 * expected);
}

TEST(ImuSensor, SameSeedSameReadings) {
  const Trajectory trajectory = drive_for(5.0);
  ImuSensor first(trajectory, {}), second(trajectory, {});
  for (int k = 0; k < 100; ++k) EXPECT_EQ(first.read().accel_mps2, second.read().accel_mps2);
}

}  // namespace
}  // namespace edgesplat::simulate
