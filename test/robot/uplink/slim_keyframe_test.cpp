// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/uplink/slim_keyframe.hpp"

#include "common/io/image_file.hpp"
#include "common/map/keyframe_codec.hpp"
#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

#include <random>

namespace edgesplat::uplink {
namespace {

map::Keyframe with_picture(std::size_t points, int width_px, int height_px) {
  map::Keyframe keyframe = test::random_keyframe(1, points, 1);
  sensor::ImageRgb8 picture(width_px, height_px);
  std::mt19937 random(3);
  for (auto& value : picture.values) value = static_cast<std::uint8_t>(random() & 0xFFU);
  auto image = std::make_shared<map::EncodedImage>();
  image->width_px = width_px;
  image->height_px = height_px;
  image->bytes = *io::encode_jpeg(picture, 95);
  keyframe.image = image;
  return keyframe;
}

TEST(SlimKeyframe, SmallOnesStayAsTheyAre) {
  const auto keyframe = with_picture(100, 32, 32);
  for (const std::size_t target : {std::size_t{0}, std::size_t{100'000}}) {
    const auto slim = slim_keyframe(keyframe, target);
    EXPECT_EQ(slim.points_in_body.size(), 100U);
    EXPECT_EQ(slim.image, keyframe.image);
  }
}

TEST(SlimKeyframe, LargeOnesComeNearTheTarget) {
  const auto keyframe = with_picture(20'000, 320, 240);
  ASSERT_GT(map::encode_keyframe(keyframe)->size(), 250'000U);
  const auto slim = slim_keyframe(keyframe, 120'000);
  EXPECT_LE(map::encode_keyframe(slim)->size(), 125'000U);
  EXPECT_GT(slim.points_in_body.size(), 4'000U);
  const auto picture = io::decode_rgb8(slim.image->bytes);
  ASSERT_TRUE(picture.has_value());
  EXPECT_EQ(picture->width_px, 320);
}

TEST(SlimKeyframe, PointsGetWhatASmallPictureLeaves) {
  const auto keyframe = with_picture(20'000, 64, 64);
  const auto slim = slim_keyframe(keyframe, 100'000);
  EXPECT_EQ(slim.image, keyframe.image);
  EXPECT_LE(map::encode_keyframe(slim)->size(), 105'000U);
  EXPECT_GT(slim.points_in_body.size(), 6'000U);
}

TEST(SlimKeyframe, ABrokenPictureStaysAndDoesNoHarm) {
  auto keyframe = with_picture(10, 320, 240);
  auto broken = std::make_shared<map::EncodedImage>(*keyframe.image);
  broken->bytes.resize(broken->bytes.size() / 2);
  keyframe.image = broken;
  EXPECT_EQ(slim_keyframe(keyframe, 10'000).image, broken);
}

}  // namespace
}  // namespace edgesplat::uplink
