// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/trajectory.hpp"

#include "common/geometry/so3.hpp"
#include "test/tools/simulate/box_world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace edgesplat::simulate {
namespace {

Trajectory make_trajectory(double duration_s = 20.0) {
  TrajectoryConfig config;
  config.duration_s = duration_s;
  auto trajectory = Trajectory::create(BoxWorld().path(), config);
  EXPECT_TRUE(trajectory.has_value());
  return *std::move(trajectory);
}

TEST(Trajectory, StandsStillAtFirst) {
  const Trajectory trajectory = make_trajectory();
  const BodyState start = trajectory.at(0.0), later = trajectory.at(1.3);
  EXPECT_LT((start.world_from_body.translation_m - later.world_from_body.translation_m).norm(), 1e-12);
  EXPECT_LT(later.acceleration_mps2.norm(), 1e-9);
  EXPECT_LT(later.angular_velocity_radps.norm(), 1e-9);
}

TEST(Trajectory, DrivesAtThePathsSpeedAndTurnsBelowTheLimit) {
  const Trajectory trajectory = make_trajectory();
  double driven_m = 0.0, fastest_mps = 0.0, fastest_turn_radps = 0.0;
  for (double t = 0.0; t < 20.0; t += 0.01) {
    const BodyState state = trajectory.at(t);
    driven_m += state.velocity_mps.norm() * 0.01;
    fastest_mps = std::max(fastest_mps, state.velocity_mps.norm());
    fastest_turn_radps = std::max(fastest_turn_radps, std::abs(state.angular_velocity_radps.z()));
  }
  EXPECT_GT(driven_m, 17.0);
  EXPECT_LT(driven_m, 24.0);
  EXPECT_LT(fastest_mps, 1.35);
  EXPECT_LT(fastest_turn_radps, 1.0);
}

TEST(Trajectory, SpinsBothWaysAtTheRateAsked) {
  TrajectoryConfig config;
  config.duration_s = 20.0;
  config.spin_radps = 3.1416;
  const auto trajectory = Trajectory::create(BoxWorld().path(), config);
  ASSERT_TRUE(trajectory.has_value());
  double left = 0.0, right = 0.0, turned_rad = 0.0;
  for (double t = 0.0; t < 20.0; t += 0.01) {
    const BodyState state = trajectory->at(t);
    left = std::max(left, state.angular_velocity_radps.z());
    right = std::min(right, state.angular_velocity_radps.z());
    turned_rad += std::abs(state.angular_velocity_radps.z()) * 0.01;
    EXPECT_LT(state.velocity_mps.norm(), 1.35);
  }
  EXPECT_NEAR(left, 3.1416, 0.9);  // the road turns too
  EXPECT_NEAR(right, -3.1416, 0.9);
  EXPECT_GT(turned_rad, 6.0 * 2.0 * 3.1416);
  EXPECT_LT(trajectory->at(1.4).angular_velocity_radps.norm(), 1e-6);
}

TEST(Trajectory, HeadsAlongItsVelocity) {
  const Trajectory trajectory = make_trajectory();
  for (double t = 4.0; t < 20.0; t += 0.1) {
    const BodyState state = trajectory.at(t);
    const Eigen::Vector3d in_body = state.world_from_body.rotation.conjugate() * state.velocity_mps;
    EXPECT_GT(in_body.x(), 0.9 * in_body.norm()) << t;
  }
}

TEST(Trajectory, DerivativesAgreeWithCentralDifferences) {
  const Trajectory trajectory = make_trajectory();
  constexpr double h = 1e-4;
  for (double t = 0.5; t < 19.5; t += 0.0731) {
    const BodyState state = trajectory.at(t), before = trajectory.at(t - h), after = trajectory.at(t + h);
    const Eigen::Vector3d velocity =
        (after.world_from_body.translation_m - before.world_from_body.translation_m) / (2 * h);
    const Eigen::Vector3d acceleration = (after.velocity_mps - before.velocity_mps) / (2 * h);
    const Eigen::Vector3d rate =
        geometry::so3_log(before.world_from_body.rotation.conjugate() * after.world_from_body.rotation) /
        (2 * h);
    EXPECT_LT((velocity - state.velocity_mps).norm(), 1e-6) << t;
    EXPECT_LT((acceleration - state.acceleration_mps2).norm(), 1e-4) << t;
    EXPECT_LT((rate - state.angular_velocity_radps).norm(), 1e-5) << t;
  }
}

TEST(Trajectory, IsSmoothAcrossKnots) {
  const Trajectory trajectory = make_trajectory();
  for (double knot_s = 0.05; knot_s < 19.9; knot_s += 0.05) {
    const BodyState before = trajectory.at(knot_s - 1e-9), after = trajectory.at(knot_s + 1e-9);
    EXPECT_LT((before.acceleration_mps2 - after.acceleration_mps2).norm(), 1e-6) << knot_s;
    EXPECT_LT((before.angular_velocity_radps - after.angular_velocity_radps).norm(), 1e-7) << knot_s;
  }
}

TEST(Trajectory, StopsAtTheEndOfAnOpenPath) {
  TrajectoryConfig config;
  config.duration_s = 20.0;
  const World::Path path{{{0, 0, 0.5}, {5, 0, 0.5}}, false, 1.2};
  const auto trajectory = Trajectory::create(path, config);
  ASSERT_TRUE(trajectory.has_value());
  const BodyState end = trajectory->at(20.0);
  EXPECT_NEAR(end.world_from_body.translation_m.x(), 5.0, 0.15);
  EXPECT_LT(end.velocity_mps.norm(), 0.02);
}

TEST(Trajectory, SameSeedSamePathOtherSeedOtherSway) {
  TrajectoryConfig config;
  const auto path = BoxWorld().path();
  const auto first = Trajectory::create(path, config), second = Trajectory::create(path, config);
  config.seed = 2;
  const auto other = Trajectory::create(path, config);
  const auto position = [](const auto& trajectory) { return trajectory->world_from_body(7.0).translation_m; };
  EXPECT_EQ(position(first), position(second));
  EXPECT_NE(position(first), position(other));
}

TEST(Trajectory, RefusesPathsThatAreNone) {
  TrajectoryConfig config;
  EXPECT_FALSE(Trajectory::create({{}, true, 1.2}, config).has_value());
  EXPECT_FALSE(Trajectory::create({{{1, 1, 1}, {1, 1, 1}}, false, 1.2}, config).has_value());
  EXPECT_FALSE(Trajectory::create({{{0, 0, 0}, {1, 0, 0}}, false, 0.0}, config).has_value());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(Trajectory::create({{{0, 0, 0}, {nan, 0, 0}}, false, 1.0}, config).has_value());
  config.duration_s = -1.0;
  EXPECT_FALSE(Trajectory::create(BoxWorld().path(), config).has_value());
}

}  // namespace
}  // namespace edgesplat::simulate
