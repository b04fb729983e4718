// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/thin_points.hpp"

#include "robot/keyframe/coloured_map.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace edgesplat::keyframe {
namespace {

map::ColouredPoint at(float x, float y, float z) {
  return {Eigen::Vector3f(x, y, z), {1, 2, 3}, true};
}

TEST(ThinPoints, KeepsTheFirstOfEachCellInOrder) {
  const auto kept = thin_points({at(0.01F, 0, 0), at(0.02F, 0, 0), at(-0.01F, 0, 0), at(0.11F, 0, 0)}, 0.1F);
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_FLOAT_EQ(kept[0].p_in_body_m.x(), 0.01F);
  EXPECT_FLOAT_EQ(kept[1].p_in_body_m.x(), -0.01F);  // negative side is a cell of its own
  EXPECT_FLOAT_EQ(kept[2].p_in_body_m.x(), 0.11F);
}

TEST(ThinPoints, ZeroSpacingKeepsAllAndBadPointsAreDroppedOtherwise) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(thin_points({at(0, 0, 0), at(0, 0, 0)}, 0.0F).size(), 2U);
  EXPECT_TRUE(thin_points({at(nan, 0, 0), at(1e30F, 0, 0)}, 0.1F).empty());
  EXPECT_TRUE(thin_points({}, 0.1F).empty());
}

TEST(ColouredMap, MergesKeyframesOnOneGridAndHoldsItsBound) {
  ColouredMap coloured(0.1, 2);
  map::Keyframe keyframe;
  keyframe.odom_from_body.translation_m = {10, 0, 0};
  keyframe.points_in_body = {at(0.05F, 0, 0), at(0.06F, 0, 0), at(1.05F, 0, 0), at(2.05F, 0, 0)};
  coloured.add(keyframe);
  coloured.add(keyframe);
  ASSERT_EQ(coloured.points().size(), 2U);
  EXPECT_NEAR(coloured.points()[0].p_in_odom_m.x(), 10.05F, 1e-5F);
  EXPECT_EQ(coloured.dropped(), 2);
}

}  // namespace
}  // namespace edgesplat::keyframe
