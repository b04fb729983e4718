// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/ground.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace edgesplat::mapping {
namespace {

/// A floor z = slope * x - height seen from a body at the origin of a turned map, and a wall beside it.
std::vector<map::ColouredPoint> floor_and_wall(double slope, double height_m, std::size_t on_floor,
                                               std::size_t on_wall) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(1.0, 6.0), across(-2.0, 2.0), up(-0.3, 2.0);
  std::normal_distribution<double> noise(0.0, 0.01);
  std::vector<map::ColouredPoint> points;
  for (std::size_t i = 0; i < on_floor; ++i) {
    const double x = along(random);
    points.push_back(
        {Eigen::Vector3d(x, across(random), slope * x - height_m + noise(random)).cast<float>(), {}, true});
  }
  for (std::size_t i = 0; i < on_wall; ++i) {
    points.push_back({Eigen::Vector3d(along(random), 2.0, up(random)).cast<float>(), {}, true});
  }
  return points;
}

TEST(FindGround, FindsALevelFloorBesideAWall) {
  geometry::RigidTransform map_from_body;
  map_from_body.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  map_from_body.translation_m = {10.0, -4.0, 2.5};
  const auto ground = find_ground(floor_and_wall(0.0, 0.6, 2000, 3000), map_from_body, {});
  ASSERT_TRUE(ground.has_value());
  EXPECT_NEAR(ground->offset_m / ground->normal.z(), 2.5 - 0.6, 0.02);
  EXPECT_GT(ground->normal.z(), 0.999);
}

TEST(FindGround, FollowsARampSomewhat) {
  GroundOptions options;
  options.band_m = 0.3;
  const double slope = 0.08;
  const auto ground = find_ground(floor_and_wall(slope, 0.8, 4000, 0), {}, options);
  ASSERT_TRUE(ground.has_value());
  EXPECT_NEAR(-ground->normal.x() / ground->normal.z(), slope, 0.02);
}

TEST(FloorDepth, IsWhereARayMeetsTheFloor) {
  geometry::RigidTransform map_from_camera;  // 1.5 m over the floor, looking along x
  map_from_camera.translation_m = {3.0, 4.0, 2.0};
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  map_from_camera.rotation = Eigen::Quaterniond(axes);
  const FloorDepth floor({Eigen::Vector3d::UnitZ(), 0.5}, map_from_camera);
  EXPECT_NEAR(floor.height_m(), 1.5F, 1e-6F);
  EXPECT_NEAR(1.0F / floor.inverse_depth({0.0F, 0.1F, 1.0F}), 15.0F, 1e-4F);
  EXPECT_NEAR(1.0F / floor.inverse_depth({7.0F, 0.5F, 1.0F}), 3.0F, 1e-5F) << "sideways it is as far";
  EXPECT_EQ(floor.inverse_depth({0.0F, 0.0F, 1.0F}), 0.0F) << "the horizon";
  EXPECT_LT(floor.inverse_depth({0.0F, -0.2F, 1.0F}), 0.0F) << "the sky";
}

TEST(FindGround, FindsNoneWhereNothingLiesBelow) {
  EXPECT_FALSE(find_ground({}, {}, {}));
  EXPECT_FALSE(find_ground(floor_and_wall(0.0, 0.6, 30, 0), {}, {})) << "too few points";
  EXPECT_FALSE(find_ground(floor_and_wall(0.0, 9.0, 3000, 0), {}, {})) << "too far below to stand on";
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<map::ColouredPoint> broken(500, {{nan, nan, nan}, {}, true});
  EXPECT_FALSE(find_ground(broken, {}, {}));
}

}  // namespace
}  // namespace edgesplat::mapping
