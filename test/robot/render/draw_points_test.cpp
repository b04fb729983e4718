// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/render/draw_points.hpp"

#include <gtest/gtest.h>

namespace edgesplat::render {
namespace {

const geometry::CameraModel kCamera{geometry::CameraKind::kPinhole, 20, 10, 10.0, 10.0, 9.5, 4.5, {}};

map::ColouredPoint at(float x, float y, float z) {
  return {Eigen::Vector3f(x, y, z), {0, 0, 0}, true};
}

TEST(DrawPoints, NearIsRedAndDrawnOverFarBlue) {
  sensor::ImageRgb8 image(20, 10);
  const std::vector<map::ColouredPoint> points = {at(0, 0, 0.01F), at(0, 0, 30.0F), at(4, 0, 30.0F)};
  draw_points_by_depth(points, {}, kCamera, 30.0, image);
  EXPECT_GT(image.pixel(10, 5)[0], 200);
  EXPECT_EQ(image.pixel(10, 5)[2], 0);
  EXPECT_GT(image.pixel(12, 5)[2], 200);
}

TEST(DrawPoints, BehindOutsideAndBorderAreSafe) {
  sensor::ImageRgb8 image(20, 10);
  const std::vector<map::ColouredPoint> points = {at(0, 0, -1), at(100, 0, 1), at(0.99F, 0.49F, 1),
                                                  at(-0.99F, -0.49F, 1)};
  draw_points_by_depth(points, {}, kCamera, 30.0, image);
  EXPECT_EQ(image.pixel(10, 5)[0] + image.pixel(10, 5)[1] + image.pixel(10, 5)[2], 0);
}

}  // namespace
}  // namespace edgesplat::render
