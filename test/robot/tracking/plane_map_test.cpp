// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/plane_map.hpp"

#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;

const Symmetric3f kNoise = pack((1e-4F * Eigen::Matrix3f::Identity()).eval());

void add_floor(PlaneMap& map, double from_m, double to_m, double height_m, std::uint64_t seed = 1) {
  test::Random random(seed);
  const double area = (to_m - from_m) * (to_m - from_m);
  for (int i = 0; i < static_cast<int>(200.0 * area); ++i) {
    map.insert(
        {{random.uniform(from_m, to_m), random.uniform(from_m, to_m), height_m + 0.01 * random.normal()},
         kNoise},
        {0.0, 0.0, 2.0});
  }
}

TEST(PlaneMap, FindsThePlaneUnderAPoint) {
  PlaneMap map({});
  add_floor(map, -3.0, 3.0, 0.3);
  for (const Vector3d& p :
       {Vector3d(1.2, 0.4, 0.35), Vector3d(-1.2, -0.4, 0.35), Vector3d(-0.2, 2.1, 0.35)}) {
    const PlaneMatch match = map.find(p);
    ASSERT_NE(match.plane, nullptr) << p.transpose();
    EXPECT_NEAR(std::abs(match.plane->normal.z()), 1.0F, 0.01F);
    EXPECT_NEAR(std::abs(match.plane->normal.dot(match.from_centre_m)), 0.05F, 0.01F);
  }
}

TEST(PlaneMap, IsEmptyWhereNothingWasInserted) {
  PlaneMap map({});
  EXPECT_EQ(map.find({0, 0, 0}).plane, nullptr);
  add_floor(map, 0.0, 2.0, 0.5);
  EXPECT_EQ(map.find({0.5, 0.5, 1.5}).plane, nullptr);
  EXPECT_EQ(map.find({-0.5, 0.5, 0.5}).plane, nullptr);
}

TEST(PlaneMap, LooksBeyondTheFaceNearestToThePoint) {
  PlaneMap map({});
  add_floor(map, 0.0, 2.0, 0.02);
  const Vector3d below(0.5, 0.5, -0.01);  // in the cell below, which is empty
  EXPECT_EQ(map.find(below).plane, nullptr);
  const PlaneMatch match = map.find_beyond_face(below);
  ASSERT_NE(match.plane, nullptr);
  EXPECT_NEAR(std::abs(match.plane->normal.dot(match.from_centre_m)), 0.03F, 0.01F);
}

TEST(PlaneMap, PlanesFaceTheLidarThatSawThem) {
  PlaneMap floor({}), ceiling({});
  test::Random random(7);
  for (int i = 0; i < 400; ++i) {
    const MapPoint point{{random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), 0.3}, kNoise};
    floor.insert(point, {0.5, 0.5, 2.3});
    ceiling.insert(point, {0.5, 0.5, -1.7});
  }
  const Plane* above = floor.find({0.5, 0.5, 0.3}).plane;
  const Plane* below = ceiling.find({0.5, 0.5, 0.3}).plane;
  ASSERT_TRUE(above != nullptr && below != nullptr);
  EXPECT_GT(above->normal.z(), 0.99F);
  EXPECT_LT(below->normal.z(), -0.99F);
  EXPECT_GT(above->seen_from.z(), 0.9F);
  EXPECT_LT(below->seen_from.z(), -0.9F);
  EXPECT_NEAR(above->seen_from.norm(), 1.0F, 1e-5F);
}

TEST(PlaneMap, SplitsACornerIntoItsPlanes) {
  PlaneMap map({});
  test::Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const double u = random.uniform(0.0, 1.0), v = random.uniform(0.0, 1.0);
    if (i % 2 == 0) {
      map.insert({{u, v, 0.1}, kNoise}, {1.0, 1.0, 1.0});
    } else {
      map.insert({{0.1, u, v}, kNoise}, {1.0, 1.0, 1.0});
    }
  }
  const PlaneMatch floor = map.find({0.9, 0.4, 0.1});
  const PlaneMatch wall = map.find({0.1, 0.4, 0.9});
  ASSERT_NE(floor.plane, nullptr);
  ASSERT_NE(wall.plane, nullptr);
  EXPECT_GT(std::abs(floor.plane->normal.z()), 0.99F);
  EXPECT_GT(std::abs(wall.plane->normal.x()), 0.99F);
}

TEST(PlaneMap, AFrozenPlaneTakesNoMorePointsAndNoMoreMemory) {
  PlaneMapConfig config;
  config.plane_freeze_points = 60;
  PlaneMap map(config);
  add_floor(map, 0.05, 0.95, 0.5);
  add_floor(map, 0.05, 0.95, 0.5, 2);
  const std::size_t bytes = map.bytes();
  const Eigen::Vector3f centre = map.find({0.5, 0.5, 0.5}).plane->centre_m;
  add_floor(map, 0.05, 0.95, 0.6, 3);
  EXPECT_EQ(map.bytes(), bytes);
  EXPECT_EQ(map.find({0.5, 0.5, 0.5}).plane->centre_m, centre);
}

TEST(PlaneMap, ForgetsWhatLeavesTheBox) {
  PlaneMapConfig config;
  config.half_extent_m = 10.0;
  PlaneMap map(config);
  add_floor(map, 0.0, 3.0, 0.5);
  const std::size_t roots = map.roots();
  map.slide({1.0, 1.0, 0.0});
  EXPECT_EQ(map.roots(), roots);
  map.slide({11.5, 1.0, 0.0});  // cells with their middle at x < 1.5 m are outside
  EXPECT_EQ(map.roots(), roots - 3);
  EXPECT_EQ(map.find({0.5, 0.5, 0.5}).plane, nullptr);
  EXPECT_NE(map.find({2.5, 0.5, 0.5}).plane, nullptr);
  EXPECT_EQ(map.evicted_roots(), 3);
}

TEST(PlaneMap, StaysWithinItsBytesAndKeepsWhatIsNear) {
  PlaneMapConfig config;
  config.max_bytes = std::size_t{1} << 20U;
  PlaneMap map(config);
  test::Random random(5);
  for (int i = 0; i < 60000; ++i) {
    map.insert({random.vector(40.0), kNoise}, {0.0, 0.0, 0.0});  // a cloud without planes: the worst case
    if (i % 1000 == 0) map.slide({0, 0, 0});
  }
  map.slide({0, 0, 0});
  EXPECT_LE(map.bytes(), config.max_bytes);
  EXPECT_GT(map.roots(), 100U);
  EXPECT_GT(map.evicted_roots(), 1000);
}

TEST(PlaneMap, AnErasedPlaceCanBeMappedAgain) {
  PlaneMapConfig config;
  config.half_extent_m = 10.0;
  PlaneMap map(config);
  for (int round = 0; round < 5; ++round) {
    add_floor(map, 0.0, 5.0, 0.5, static_cast<std::uint64_t>(round));
    EXPECT_NE(map.find({2.5, 2.5, 0.5}).plane, nullptr);
    map.slide({100.0, 0.0, 0.0});
    EXPECT_EQ(map.roots(), 0U);
    map.slide({0.0, 0.0, 0.0});
  }
}

}  // namespace
}  // namespace edgesplat::tracking
