// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/keyframe_builder.hpp"

#include "common/io/image_file.hpp"
#include "test/robot/keyframe/keyframe_fixture.hpp"

#include <gtest/gtest.h>

namespace edgesplat::keyframe {
namespace {

sync::GroupImage picture() {
  return {std::make_shared<sensor::ImageRgb8>(red_blue_image()), 0.005F, 0.0F, 1};
}

TEST(KeyframeBuilder, FirstTrackedPictureIsAKeyframeWithItsPoints) {
  KeyframeBuilder builder(KeyframeConfig{}, forward_rig());
  auto group = tracked_at(1.0, {1, 0, 0});
  add_wall(group, 4.0F, 1.0F, 0.25F);
  const auto made = builder.add(group, picture());
  ASSERT_TRUE(made.has_value()) << made.error().context;
  ASSERT_NE(*made, nullptr);
  const map::Keyframe& keyframe = **made;
  EXPECT_EQ(keyframe.id.value, 0U);
  EXPECT_EQ(keyframe.points_in_body.size(), group.points_in_body.size());
  EXPECT_NEAR(keyframe.points_in_body.front().p_in_body_m.x(), 4.0F, 1e-5F);
  ASSERT_NE(keyframe.image, nullptr);
  const auto decoded = io::decode_image(keyframe.image->bytes);
  ASSERT_TRUE(decoded.has_value());
}

TEST(KeyframeBuilder, StandingStillMakesNoSecondKeyframe) {
  KeyframeBuilder builder(KeyframeConfig{}, forward_rig());
  ASSERT_NE(*builder.add(tracked_at(1.0, {0, 0, 0}), picture()), nullptr);
  for (int i = 1; i < 50; ++i)
    EXPECT_EQ(*builder.add(tracked_at(1.0 + 0.1 * i, {0.001 * i, 0, 0}), picture()), nullptr);
}

TEST(KeyframeBuilder, MotionOrRotationMakesOneWithTheNextId) {
  KeyframeBuilder builder(KeyframeConfig{}, forward_rig());
  ASSERT_NE(*builder.add(tracked_at(1.0, {0, 0, 0}), picture()), nullptr);
  const auto moved = builder.add(tracked_at(2.0, {0.5, 0, 0}), picture());
  ASSERT_NE(*moved, nullptr);
  EXPECT_EQ((*moved)->id.value, 1U);
  auto turned = tracked_at(3.0, {0.5, 0, 0});
  turned.odom_from_body.rotation = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ());
  EXPECT_NE(*builder.add(turned, picture()), nullptr);
}

TEST(KeyframeBuilder, NothingIsBuiltWhileInitialisingOrCoastingOrBlind) {
  KeyframeBuilder builder(KeyframeConfig{}, forward_rig());
  auto group = tracked_at(1.0, {0, 0, 0});
  group.health.state = tracking::TrackingState::kInitialising;
  EXPECT_EQ(*builder.add(group, picture()), nullptr);
  group.health.state = tracking::TrackingState::kCoasting;
  EXPECT_EQ(*builder.add(group, picture()), nullptr);
  group.health.state = tracking::TrackingState::kTracking;
  EXPECT_EQ(*builder.add(group, std::nullopt), nullptr);
}

TEST(KeyframeBuilder, WhatIsHeldOutGivesNeitherColoursNorAKeyframe) {
  KeyframeConfig config;
  KeyframeBuilder builder(config, forward_rig());
  auto group = tracked_at(1.0, {1, 0, 0});
  add_wall(group, 4.0F, 1.0F, 0.25F);
  const std::size_t points = group.points_in_body.size();
  auto green = std::make_shared<sensor::ImageRgb8>(100, 80);
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 100; ++x) green->pixel(x, y)[1] = 250;
  const auto held_out = builder.hold_out(group, {green, 0.005F, 0.0F, 1});
  ASSERT_TRUE(held_out.has_value()) << held_out.error().context;
  ASSERT_NE(*held_out, nullptr);
  EXPECT_EQ((*held_out)->stamp, group.stamp);
  EXPECT_TRUE((*held_out)->points_in_body.empty());
  ASSERT_NE((*held_out)->image, nullptr);
  EXPECT_GT(io::decode_rgb8((*held_out)->image->bytes)->pixel(50, 40)[1], 200);
  // The next picture makes the first keyframe, with the points that waited, in its own colours.
  const auto next = builder.add(tracked_at(1.1, {1, 0, 0}), picture());
  ASSERT_NE(*next, nullptr);
  EXPECT_EQ((*next)->id.value, 0U);
  ASSERT_EQ((*next)->points_in_body.size(), points);
  for (const auto& point : (*next)->points_in_body) EXPECT_LT(point.rgb[1], 10);
}

TEST(KeyframeBuilder, NothingIsHeldOutWithoutAPose) {
  KeyframeBuilder builder(KeyframeConfig{}, forward_rig());
  auto group = tracked_at(1.0, {0, 0, 0});
  for (const auto state : {tracking::TrackingState::kInitialising, tracking::TrackingState::kCoasting}) {
    group.health.state = state;
    EXPECT_EQ(*builder.hold_out(group, picture()), nullptr);
  }
}

TEST(KeyframeBuilder, PictureOfAnotherSizeIsAnError) {
  KeyframeBuilder builder(KeyframeConfig{}, forward_rig());
  const sync::GroupImage wrong{std::make_shared<sensor::ImageRgb8>(64, 48), 0.0F, 0.0F, 1};
  const auto made = builder.add(tracked_at(1.0, {0, 0, 0}), wrong);
  ASSERT_FALSE(made.has_value());
  EXPECT_NE(made.error().context.find("64x48"), std::string::npos);
}

TEST(KeyframeBuilder, LidarOnlyRigSendsGreyPoints) {
  auto rig = forward_rig();
  rig.camera.reset();
  KeyframeBuilder builder(KeyframeConfig{}, rig);
  auto group = tracked_at(1.0, {0, 0, 0});
  add_wall(group, 4.0F, 1.0F, 0.5F);
  const auto made = builder.add(group, std::nullopt);
  ASSERT_NE(*made, nullptr);
  EXPECT_EQ((*made)->image, nullptr);
  ASSERT_FALSE((*made)->points_in_body.empty());
  EXPECT_EQ((*made)->points_in_body[0].rgb, (std::array<std::uint8_t, 3>{140, 140, 140}));
}

}  // namespace
}  // namespace edgesplat::keyframe
