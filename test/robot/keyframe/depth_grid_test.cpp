// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/depth_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::keyframe {
namespace {

TEST(DepthGrid, EmptyHidesNothing) {
  const DepthGrid grid(100, 80, 8);
  EXPECT_TRUE(std::isinf(grid.nearest_around(50, 40)));
  EXPECT_TRUE(grid.visible(50, 40, 1000.0F, 0.1F, 0.0F));
}

TEST(DepthGrid, NearSurfaceHidesWhatIsBehindItAndInTheCellsAround) {
  DepthGrid grid(100, 80, 8);
  grid.insert(50, 40, 2.0F);
  EXPECT_TRUE(grid.visible(50, 40, 2.05F, 0.1F, 0.0F));
  EXPECT_FALSE(grid.visible(50, 40, 3.0F, 0.1F, 0.0F));
  EXPECT_FALSE(grid.visible(57, 40, 3.0F, 0.1F, 0.0F));
  EXPECT_TRUE(grid.visible(80, 40, 3.0F, 0.1F, 0.0F));
}

TEST(DepthGrid, RelativeMarginGrowsWithDepth) {
  DepthGrid grid(100, 80, 8);
  grid.insert(50, 40, 20.0F);
  EXPECT_FALSE(grid.visible(50, 40, 20.9F, 0.1F, 0.0F));
  EXPECT_TRUE(grid.visible(50, 40, 20.9F, 0.1F, 0.05F));
}

TEST(DepthGrid, BorderPixelsAndClear) {
  DepthGrid grid(101, 81, 8);
  grid.insert(-0.5, -0.5, 1.0F);
  grid.insert(100.4, 80.4, 1.0F);
  EXPECT_FLOAT_EQ(grid.nearest_around(0, 0), 1.0F);
  EXPECT_FLOAT_EQ(grid.nearest_around(100, 80), 1.0F);
  grid.clear();
  EXPECT_TRUE(std::isinf(grid.nearest_around(0, 0)));
}

}  // namespace
}  // namespace edgesplat::keyframe
