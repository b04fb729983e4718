// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/rest_detector.hpp"

#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;

/// Groups of 0.1 s from an IMU whose body swings by `swing_rad` at 1 Hz.
class Swinging {
 public:
  explicit Swinging(double swing_rad) : swing_rad_(swing_rad) {}

  std::vector<sync::GroupImu> next_group() {
    std::vector<sync::GroupImu> imu;
    for (int i = 0; i < 20; ++i) {
      const double t = 0.005 * ++count_;
      const auto noise = [&](double density) -> Vector3d {
        return density * std::sqrt(200.0) * Vector3d(random_.normal(), random_.normal(), random_.normal());
      };
      const double rate = swing_rad_ * 2.0 * M_PI * std::cos(2.0 * M_PI * t);
      imu.push_back({HostTime(from_seconds(t)), Vector3d(rate, 0, 0) + noise(2e-3),
                     Vector3d(0, 0, 9.81) + noise(2e-2)});
    }
    return imu;
  }

 private:
  double swing_rad_;
  int count_ = 0;
  test::Random random_{3};
};

TEST(RestDetector, TakesHalfASecondOfQuiet) {
  RestDetector rest{sensor::ImuModel{}};
  Swinging body(0.0);
  int at_rest = 0;
  for (int i = 0; i < 100; ++i) {
    const bool now = rest.add(body.next_group(), FilterState{});
    EXPECT_FALSE(now && i < 5);
    at_rest += now ? 1 : 0;
  }
  EXPECT_GT(at_rest, 85);
}

TEST(RestDetector, FeelsTheSwayOfADrive) {
  RestDetector rest{sensor::ImuModel{}};
  Swinging body(0.007);
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(rest.add(body.next_group(), FilterState{})) << i;
}

TEST(RestDetector, ATiltedBodyOrABiasIsNoMotion) {
  FilterState state;
  state.odom_from_body.rotation = Eigen::AngleAxisd(0.3, Vector3d::UnitX());
  state.gyro_bias_radps = {0.01, 0.0, -0.02};
  state.accel_bias_mps2 = {0.1, 0.0, 0.0};
  RestDetector rest{sensor::ImuModel{}};
  Swinging body(0.0);
  bool found = false;
  for (int i = 0; i < 20; ++i) {
    auto imu = body.next_group();
    for (sync::GroupImu& sample : imu) {
      sample.accel_mps2 =
          state.odom_from_body.rotation.conjugate() * sample.accel_mps2 + state.accel_bias_mps2;
      sample.gyro_radps += state.gyro_bias_radps;
    }
    found = rest.add(imu, state) || found;
  }
  EXPECT_TRUE(found);
  EXPECT_FALSE(rest.add({}, state));
}

TEST(HoldVelocity, StopsOneDirectionAndWhatHangsOnIt) {
  FilterBelief belief;
  belief.state.velocity_in_odom_mps = {0.4, 0.3, 0.0};
  belief.covariance(kPos, kVel) = belief.covariance(kVel, kPos) = 0.5;
  hold_velocity(belief, Vector3d(1, 0, 0).asDiagonal(), 1e-3);
  EXPECT_NEAR(belief.state.velocity_in_odom_mps.x(), 0.0, 1e-5);
  EXPECT_NEAR(belief.state.velocity_in_odom_mps.y(), 0.3, 1e-12);
  EXPECT_NEAR(belief.state.odom_from_body.translation_m.x(), -0.2, 1e-5);
  EXPECT_NEAR(belief.covariance(kVel, kVel), 1e-6, 1e-9);
  EXPECT_NEAR(belief.covariance(kPos, kPos), 0.75, 1e-5);
  EXPECT_NEAR(belief.covariance(kVel + 1, kVel + 1), 1.0, 1e-12);
}

}  // namespace
}  // namespace edgesplat::tracking
