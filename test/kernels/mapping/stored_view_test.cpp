// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/stored_view.hpp"

#include <gtest/gtest.h>

namespace edgesplat::mapping {
namespace {

geometry::CameraModel camera() {
  return {geometry::CameraKind::kPinhole, 64, 48, 50.0, 50.0, 31.5, 23.5, {}};
}

map::ColouredPoint point(float x, float y, float z) {
  return {{x, y, z}, {10, 20, 30}, true};
}

TEST(ProjectDepths, PutsAPointIntoThePixelWhoseCentreIsNearest) {
  // (41, 13) px at 2 m: x = (41 - 31.5) / 50 * 2
  const auto depths = project_depths(std::vector{point(0.38F, -0.42F, 2.0F)}, {}, camera());
  ASSERT_EQ(depths.size(), 1U);
  EXPECT_EQ(depths[0].pixel, 13U * 64U + 41U);
  EXPECT_FLOAT_EQ(depths[0].depth_m, 2.0F);
}

TEST(ProjectDepths, KeepsTheNearestOfAPixelWhateverTheOrder) {
  const std::vector near_first{point(0.0F, 0.0F, 2.0F), point(0.0F, 0.0F, 5.0F)};
  const std::vector far_first{point(0.0F, 0.0F, 5.0F), point(0.0F, 0.0F, 2.0F)};
  for (const auto& points : {near_first, far_first}) {
    const auto depths = project_depths(points, {}, camera());
    ASSERT_EQ(depths.size(), 1U);
    EXPECT_FLOAT_EQ(depths[0].depth_m, 2.0F);
  }
}

TEST(ProjectDepths, LeavesOutWhatThePictureDoesNotShow) {
  const std::vector points{point(0, 0, -2.0F), point(0, 0, 0.05F), point(9.0F, 0, 2.0F),
                           point(std::numeric_limits<float>::quiet_NaN(), 0, 2.0F)};
  EXPECT_TRUE(project_depths(points, {}, camera()).empty());
}

TEST(AboveMeasured, IsTheSkyButNotColumnsThatNothingIsKnownOf) {
  StoredView view;
  view.undistorter = std::make_shared<image::Undistorter>(camera());
  view.depths = {{20 * 64 + 3, 5.0F}, {30 * 64 + 5, 4.0F}, {12 * 64 + 30, 6.0F}};
  EXPECT_TRUE(above_measured(30, view).empty()) << "no pixel is so far above";
  const std::vector<bool> is_above = above_measured(4, view);
  ASSERT_EQ(is_above.size(), 64U * 48U);
  const auto above = [&](std::size_t x, std::size_t y) { return is_above[y * 64 + x]; };
  EXPECT_TRUE(above(3, 15));
  EXPECT_FALSE(above(3, 16)) << "the margin";
  EXPECT_FALSE(above(3, 40));
  EXPECT_TRUE(above(30, 7));
  EXPECT_FALSE(above(30, 8));
  EXPECT_FALSE(above(20, 9)) << "a neighbouring stretch is measured as high as that";
  EXPECT_FALSE(above(63, 0)) << "nothing is known there";
}

TEST(MakeView, RefusesAPictureOfAnotherSize) {
  map::Keyframe keyframe;
  keyframe.camera.emplace();
  keyframe.camera->model = camera();
  const auto undistorter = std::make_shared<image::Undistorter>(camera());
  EXPECT_FALSE(make_view(keyframe, {}, sensor::ImageRgb8(10, 10), undistorter));
  EXPECT_TRUE(make_view(keyframe, {}, sensor::ImageRgb8(64, 48), undistorter));
}

}  // namespace
}  // namespace edgesplat::mapping
