// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/colouriser.hpp"

#include "test/robot/keyframe/keyframe_fixture.hpp"

#include <gtest/gtest.h>

namespace edgesplat::keyframe {
namespace {

TEST(Colouriser, TakesTheColourOfThePixelEachPointFallsOn) {
  Colouriser colouriser(KeyframeConfig{}, *forward_rig().camera);
  auto group = tracked_at(1.0, {5, 2, 1});
  add_wall(group, 4.0F, 1.0F, 0.25F);
  colouriser.add_points(group);
  colouriser.add_image(group, red_blue_image());
  const auto points = colouriser.take_coloured();
  ASSERT_EQ(points.size(), group.points_in_body.size());
  for (const OdomPoint& p : points) {
    const float left_m = p.p_in_odom_m.y() - 2.0F;  // body y is left: left half of the picture is red
    if (std::abs(left_m) < 0.1F) continue;
    EXPECT_EQ(p.rgb[0], left_m > 0 ? 200 : 0);
    EXPECT_EQ(p.rgb[2], left_m > 0 ? 0 : 200);
  }
}

TEST(Colouriser, EachPointIsTakenOnce) {
  Colouriser colouriser(KeyframeConfig{}, *forward_rig().camera);
  auto group = tracked_at(1.0, {0, 0, 0});
  add_wall(group, 4.0F, 1.0F, 0.5F);
  colouriser.add_points(group);
  colouriser.add_image(group, red_blue_image());
  EXPECT_FALSE(colouriser.take_coloured().empty());
  colouriser.add_image(group, red_blue_image());
  EXPECT_TRUE(colouriser.take_coloured().empty());
}

TEST(Colouriser, PointsBehindAnOccluderGetNoColour) {
  Colouriser colouriser(KeyframeConfig{}, *forward_rig().camera);
  auto group = tracked_at(1.0, {0, 0, 0});
  add_wall(group, 2.0F, 0.5F, 0.05F);  // covers pixels 25..75
  const auto occluder = group.points_in_body.size();
  add_wall(group, 8.0F, 0.8F, 0.1F);  // entirely in its shadow: pixels 39..60
  ASSERT_GT(group.points_in_body.size(), occluder);
  colouriser.add_points(group);
  colouriser.add_image(group, red_blue_image());
  const auto points = colouriser.take_coloured();
  EXPECT_EQ(points.size(), occluder);
  for (const OdomPoint& p : points) EXPECT_LT(p.p_in_odom_m.x(), 3.0F);
}

TEST(Colouriser, PointsOutsideThePictureWaitAndThenExpire) {
  Colouriser colouriser(KeyframeConfig{}, *forward_rig().camera);
  auto behind = tracked_at(1.0, {0, 0, 0});
  add_wall(behind, -3.0F, 1.0F, 0.5F);
  colouriser.add_points(behind);
  colouriser.add_image(behind, red_blue_image());
  EXPECT_TRUE(colouriser.take_coloured().empty());
  EXPECT_EQ(colouriser.waiting(), behind.points_in_body.size());

  // 0.5 s later the robot has turned round and sees them.
  auto turned = tracked_at(1.5, {0, 0, 0});
  turned.odom_from_body.rotation = Eigen::AngleAxisd(3.14159265, Eigen::Vector3d::UnitZ());
  colouriser.add_points(turned);
  colouriser.add_image(turned, red_blue_image());
  EXPECT_EQ(colouriser.take_coloured().size(), behind.points_in_body.size());

  auto later = tracked_at(5.0, {0, 0, 0});
  colouriser.add_points(later);
  EXPECT_EQ(colouriser.waiting(), 0U);
  EXPECT_EQ(colouriser.expired_without_colour(), 0);
}

TEST(Colouriser, WindowIsBounded) {
  KeyframeConfig config;
  config.window_points = 100;
  Colouriser colouriser(config, *forward_rig().camera);
  auto group = tracked_at(1.0, {0, 0, 0});
  add_wall(group, -3.0F, 1.0F, 0.05F);
  ASSERT_GT(group.points_in_body.size(), 1000U);
  colouriser.add_points(group);
  EXPECT_EQ(colouriser.waiting(), 100U);
  EXPECT_EQ(colouriser.expired_without_colour(),
            static_cast<std::int64_t>(group.points_in_body.size()) - 100);
}

}  // namespace
}  // namespace edgesplat::keyframe
