// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/imu_initialiser.hpp"

#include "common/geometry/so3.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;

const Eigen::Quaterniond kTilt = geometry::so3_exp({0.1, -0.2, 0.0});
const Vector3d kBias(0.01, -0.02, 0.005);

/// 0.5 s of a tilted IMU with a gyro bias and noise; `push`: amplitude of a 2 Hz shake along x.
std::vector<sync::GroupImu> samples(double push_mps2) {
  test::Random random(1);
  std::vector<sync::GroupImu> imu;
  for (int i = 0; i <= 100; ++i) {
    const double t = 0.005 * i;
    const Vector3d accel(push_mps2 * std::sin(12.566 * t), 0.0, 9.81);
    imu.push_back({HostTime(from_seconds(t)), kBias + 0.02 * random.vector(1.0),
                   kTilt.conjugate() * accel + 0.1 * random.vector(1.0)});
  }
  return imu;
}

TEST(ImuInitialiser, FindsLevelAndGyroBiasAtRest) {
  ImuInitialiser initialiser({}, {});
  const auto initial = initialiser.add(samples(0.0));
  ASSERT_TRUE(initial.has_value());
  const FilterState& state = initial->state;
  const Vector3d up = state.odom_from_body.rotation * (kTilt.conjugate() * Vector3d::UnitZ());
  EXPECT_GT(up.z(), 0.99999);
  EXPECT_LT((state.gyro_bias_radps - kBias).norm(), 0.003);
  EXPECT_TRUE(state.gravity_in_odom_mps2.isApprox(Vector3d(0, 0, -9.81)));
}

TEST(ImuInitialiser, CovarianceKnowsThatBiasAndLevelAreOne) {
  ImuInitialiser initialiser({}, {});
  const auto initial = initialiser.add(samples(0.0));
  ASSERT_TRUE(initial.has_value());
  // The measured acceleration R (a - ba) + g is zero whatever the bias: its variance must stay small.
  Eigen::Matrix<double, 3, kErrorSize> h = Eigen::Matrix<double, 3, kErrorSize>::Zero();
  h.block<3, 3>(0, kAccelBias) = -initial->state.odom_from_body.rotation.toRotationMatrix();
  h.block<3, 3>(0, kGravity).setIdentity();
  const Eigen::Matrix3d variance = h * initial->covariance * h.transpose();
  EXPECT_LT(std::sqrt(variance.diagonal().maxCoeff()), 0.03);
  EXPECT_GT(std::sqrt(initial->covariance(kGravity, kGravity)), 0.05);
}

TEST(ImuInitialiser, AStartInMotionWaitsForRest) {
  ImuInitialiser initialiser({}, {});
  auto shaken = samples(3.0);
  EXPECT_FALSE(initialiser.add(shaken).has_value());
  auto quiet = samples(0.0);
  for (auto& sample : quiet) sample.stamp += std::chrono::milliseconds(505);
  std::vector<sync::GroupImu> first(quiet.begin(), quiet.begin() + 50);
  EXPECT_FALSE(initialiser.add(first).has_value());
  const auto still = initialiser.add(quiet);  // the newest 0.3 s count, not what was before
  ASSERT_TRUE(still.has_value());
  EXPECT_LT((still->state.gyro_bias_radps - kBias).norm(), 0.004);
  const Vector3d up = still->state.odom_from_body.rotation * (kTilt.conjugate() * Vector3d::UnitZ());
  EXPECT_GT(up.z(), 0.9999);
}

TEST(ImuInitialiser, WaitsForEnoughAndCountsRepeatedSamplesOnce) {
  ImuInitialiser initialiser({}, {});
  auto imu = samples(0.0);
  imu.resize(40);  // 0.2 s
  EXPECT_FALSE(initialiser.add(imu).has_value());
  EXPECT_FALSE(initialiser.add(imu).has_value());
  EXPECT_FALSE(initialiser.add({}).has_value());
  EXPECT_TRUE(initialiser.add(samples(0.0)).has_value());
}

}  // namespace
}  // namespace edgesplat::tracking
