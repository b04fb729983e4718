// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/image/gray_pyramid.hpp"

#include <gtest/gtest.h>

namespace edgesplat::image {
namespace {

sensor::ImageRgb8 ramp(int width, int height) {
  sensor::ImageRgb8 picture(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) picture.pixel(x, y)[c] = static_cast<std::uint8_t>(4 * x + y);
  return picture;
}

TEST(GrayPyramid, WeighsTheColoursByBrightness) {
  sensor::ImageRgb8 picture(4, 4);
  for (int i = 0; i < 16; ++i) picture.values[static_cast<std::size_t>(3 * i + 1)] = 200;  // green
  GrayPyramid pyramid;
  pyramid.build(picture, 0, 1);
  EXPECT_EQ(*pyramid.level(0).pixel(2, 2), 117);  // 0.587 * 200
}

TEST(GrayPyramid, EachLevelIsTheMeanOfTheOneBefore) {
  GrayPyramid pyramid;
  pyramid.build(ramp(32, 17), 0, 3);
  ASSERT_EQ(pyramid.levels(), 3);
  EXPECT_EQ(pyramid.level(1).width_px, 16);
  EXPECT_EQ(pyramid.level(1).height_px, 8);  // the odd row is cut off
  EXPECT_EQ(*pyramid.level(0).pixel(5, 3), 23);
  EXPECT_NEAR(*pyramid.level(1).pixel(5, 3), 4 * 10.5 + 6.5, 0.51);
  EXPECT_NEAR(*pyramid.level(2).pixel(5, 3), 4 * 21.5 + 13.5, 1.01);
}

TEST(GrayPyramid, SkippingLevelsGivesTheSamePictures) {
  GrayPyramid whole, skipped;
  whole.build(ramp(48, 32), 0, 4);
  for (int skip = 1; skip <= 2; ++skip) {
    skipped.build(ramp(48, 32), skip, 2);
    for (int l = 0; l < 2; ++l) {
      ASSERT_EQ(skipped.level(l).values.size(), whole.level(l + skip).values.size());
      for (std::size_t i = 0; i < skipped.level(l).values.size(); ++i)
        EXPECT_NEAR(skipped.level(l).values[i], whole.level(l + skip).values[i], 1);
    }
  }
}

TEST(Halved, PixelsOfTheSmallCameraCoverThoseOfTheLargeOne) {
  geometry::CameraModel camera;
  camera.width_px = 320;
  camera.height_px = 256;
  camera.fx_px = camera.fy_px = 170.0;
  camera.cx_px = 161.2;
  camera.cy_px = 126.0;
  camera.distortion = {-0.06, 0.01, 0.0004, -0.0003};
  const Eigen::Vector3d p(0.4, -0.3, 1.3);
  const Eigen::Vector2d large = *camera.project(p);
  const Eigen::Vector2d small = *halved(camera, 2).project(p);
  EXPECT_NEAR(small.x(), (large.x() + 0.5) / 4.0 - 0.5, 1e-9);
  EXPECT_NEAR(small.y(), (large.y() + 0.5) / 4.0 - 0.5, 1e-9);
}

}  // namespace
}  // namespace edgesplat::image
