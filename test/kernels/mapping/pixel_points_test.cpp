// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/pixel_points.hpp"

#include "test/kernels/mapping/patterned_wall.hpp"

#include <gtest/gtest.h>

namespace edgesplat::mapping {
namespace {

TEST(PixelPoints, LieOnTheirPixelsRayInThePicturesColour) {
  const StoredView view = patterned_wall::seen_from({1.0, 2.0, 3.0});
  geometry::RigidTransform map_from_body;
  map_from_body.translation_m = {0.5, 0.0, 0.0};
  const PixelDepth depths[] = {{100, 20, 4.0F}};
  const auto points = points_of(depths, view, map_from_body);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_NEAR(points[0].p_in_body_m.x(), 0.5 + 4.0 * 20.5 / 120.0, 1e-5);
  EXPECT_NEAR(points[0].p_in_body_m.y(), 2.0 - 4.0 * 27.5 / 120.0, 1e-5);
  EXPECT_NEAR(points[0].p_in_body_m.z(), 7.0, 1e-5);
  EXPECT_TRUE(points[0].has_colour);
  EXPECT_EQ(points[0].rgb[0], view.picture.pixel(100, 20)[0]);
}

}  // namespace
}  // namespace edgesplat::mapping
