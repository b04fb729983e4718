// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/lidar_sensor.hpp"

#include "test/tools/simulate/box_world.hpp"

#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include <cmath>
#include <cstring>

namespace edgesplat::simulate {
namespace {

struct Statistics {
  double mean = 0.0;
  double sigma = 0.0;
  double returned = 0.0;
};

Statistics measure_often(const Shot& shot, const LidarNoiseConfig& config) {
  constexpr int kCount = 20000;
  double sum = 0.0, squares = 0.0;
  int returns = 0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const WirePoint p = measure(shot, 0.0, config, NoiseStream(3, NoisePurpose::kLidarShot, i));
    if (p.x_mm == 0 && p.y_mm == 0 && p.z_mm == 0) continue;
    const double error_m = Eigen::Vector3d(p.x_mm, p.y_mm, p.z_mm).norm() * 1e-3 - shot.range_m;
    sum += error_m, squares += error_m * error_m, ++returns;
  }
  if (returns == 0) return {};
  const double mean = sum / returns;
  return {mean, std::sqrt(squares / returns - mean * mean), static_cast<double>(returns) / kCount};
}

Shot shot_at(float range_m, float reflectivity, float cosine = 1.0F) {
  return {Eigen::Vector3d(0.6, -0.64, 0.48), range_m, cosine, reflectivity};
}

TEST(LidarReturns, RangeNoiseIsTwoCentimetresAtTenMetres) {
  const LidarNoiseConfig config;
  const Statistics typical = measure_often(shot_at(10.0F, 0.5F), config);
  EXPECT_NEAR(typical.sigma, 0.02, 0.001);
  EXPECT_NEAR(typical.mean, 0.0, 0.001);
  EXPECT_EQ(typical.returned, 1.0);
  EXPECT_GT(measure_often(shot_at(10.0F, 0.05F), config).sigma, 1.5 * typical.sigma);
  EXPECT_GT(measure_often(shot_at(10.0F, 0.5F, 0.1F), config).sigma, 1.5 * typical.sigma);
  EXPECT_LT(measure_often(shot_at(2.0F, 0.5F), config).sigma, 0.8 * typical.sigma);
}

TEST(LidarReturns, BearingNoiseIsWithinTheDataSheet) {
  LidarNoiseConfig config;
  config.range_sigma_m = 0.0;
  const Shot shot = shot_at(20.0F, 0.8F);
  double square = 0.0;
  constexpr int kCount = 5000;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const WirePoint p = measure(shot, 0.0, config, NoiseStream(5, NoisePurpose::kLidarShot, i));
    const Eigen::Vector3d direction = Eigen::Vector3d(p.x_mm, p.y_mm, p.z_mm).normalized();
    square += (direction - shot.direction).squaredNorm() / 2.0;
  }
  EXPECT_NEAR(std::sqrt(square / kCount), config.bearing_sigma_rad, 1e-4);
}

TEST(LidarReturns, ReachDependsOnReflectivity) {
  EXPECT_NEAR(detection_range_m(0.1), 40.0, 1e-9);
  EXPECT_NEAR(detection_range_m(0.8), 70.0, 1e-9);
  EXPECT_NEAR(detection_range_m(1.0), 70.0, 1e-9);
  const LidarNoiseConfig config;
  EXPECT_EQ(measure_often(shot_at(35.0F, 0.1F), config).returned, 1.0);
  EXPECT_EQ(measure_often(shot_at(41.0F, 0.1F), config).returned, 0.0);
  EXPECT_EQ(measure_often(shot_at(62.0F, 0.8F), config).returned, 1.0);
  EXPECT_EQ(measure_often(shot_at(71.0F, 0.8F), config).returned, 0.0);
}

TEST(LidarReturns, BlindZoneAndNothingHitGiveZeroPoints) {
  EXPECT_EQ(measure_often(shot_at(0.08F, 0.5F), {}).returned, 0.0);
  EXPECT_EQ(measure_often(shot_at(0.0F, 0.0F), {}).returned, 0.0);
  EXPECT_EQ(measure_often(shot_at(0.2F, 0.5F), {}).returned, 1.0);
}

TEST(LidarReturns, FewGluePointsOnlyAtEdgesAndMostlyTagged) {
  const LidarNoiseConfig config;
  int between = 0, tagged = 0, flat_tagged = 0;
  constexpr int kCount = 10000;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const NoiseStream noise(9, NoisePurpose::kLidarShot, i);
    const WirePoint edge = measure(shot_at(5.0F, 0.5F), 7.0, config, noise);
    const WirePoint flat = measure(shot_at(5.0F, 0.5F), 5.1, config, noise);
    const double range_m = Eigen::Vector3d(edge.x_mm, edge.y_mm, edge.z_mm).norm() * 1e-3;
    if (range_m > 5.15) ++between;
    if (edge.tag != 0) ++tagged;
    if (flat.tag != 0) ++flat_tagged;
  }
  EXPECT_NEAR(static_cast<double>(tagged) / kCount, 0.9 * config.glue_share, 0.02);
  EXPECT_NEAR(static_cast<double>(between) / kCount, config.glue_share, 0.03);
  EXPECT_EQ(flat_tagged, 0);
}

class LidarSensorTest : public testing::Test {
 protected:
  LidarSensorTest() {
    config_.body_from_lidar.translation_m = {-0.011, -0.02329, 0.04412};
    config_.seed = 7;
  }
  BoxWorld world_;
  Trajectory trajectory_ = *Trajectory::create(world_.path(), {});
  LidarSensorConfig config_;
};

TEST_F(LidarSensorTest, RaysLeaveAtTheirOwnTimeFromTheMovingBody) {
  config_.noise.noisy = false;
  const LidarSensor lidar(world_, trajectory_, config_);
  int returns = 0;
  for (const LidarShots& packet : lidar.packets(20000, 40)) {  // from 9.6 s on
    for (std::size_t i = 0; i < kPointsPerPacket; ++i) {
      const WirePoint& p = packet.points[i];
      const double time_s = 5e-6 * static_cast<double>(packet.first_shot + i);
      const Eigen::Vector3d in_lidar = 1e-3 * Eigen::Vector3d(p.x_mm, p.y_mm, p.z_mm);
      const auto world_from_lidar = trajectory_.world_from_body(time_s) * config_.body_from_lidar;
      const Eigen::Vector3d in_world = world_from_lidar * in_lidar;
      // Every point lies on one of the box's six sides, to the protocol's millimetre.
      const double off_m =
          std::min({std::abs(std::abs(in_world.x()) - 10.0), std::abs(std::abs(in_world.y()) - 8.0),
                    std::abs(in_world.z()), std::abs(in_world.z() - 4.0)});
      EXPECT_LT(off_m, 1e-3);
      ++returns;
    }
  }
  EXPECT_EQ(returns, 40 * 96);
}

TEST_F(LidarSensorTest, ResultDoesNotDependOnTheNumberOfThreads) {
  const LidarSensor lidar(world_, trajectory_, config_);
  const auto parallel = lidar.packets(5000, 64);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto serial = lidar.packets(5000, 64);
  ASSERT_EQ(parallel.size(), serial.size());
  for (std::size_t k = 0; k < serial.size(); ++k) {
    for (std::size_t i = 0; i < kPointsPerPacket; ++i) {
      EXPECT_EQ(parallel[k].points[i].x_mm, serial[k].points[i].x_mm);
      EXPECT_EQ(parallel[k].points[i].tag, serial[k].points[i].tag);
    }
  }
}

TEST_F(LidarSensorTest, PacketsFollowEachOtherEvery480Microseconds) {
  EXPECT_EQ(LidarSensor(world_, trajectory_, config_).packet_period(), nanoseconds(480000));
}

}  // namespace
}  // namespace edgesplat::simulate
