// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/tile_lists.hpp"

#include "kernels/splat/splat_one.hpp"
#include "test/support/random_cloud.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace edgesplat::splat {
namespace {

bool reaches_tile(const Splat& s, int column, int row) {
  for (int y = row * kTileHeightPx; y < (row + 1) * kTileHeightPx; ++y) {
    for (int x = column * kTileWidthPx; x < (column + 1) * kTileWidthPx; ++x) {
      const double dx = static_cast<double>(x) - s.u_px;
      const double dy = static_cast<double>(y) - s.v_px;
      const double power =
          -0.5 * (s.conic[0] * dx * dx + s.conic[2] * dy * dy) - static_cast<double>(s.conic[1]) * dx * dy;
      if (s.opacity * std::exp(power) >= kMinAlpha) return true;
    }
  }
  return false;
}

TEST(TileLists, HoldEverySplatThatReachesATileAndFewMore) {
  test::Random random(21);
  const auto cloud = test::random_cloud(random, {.count = 400, .half_width_m = 6.0, .scale_max_m = 1.5});
  const geometry::CameraModel model{geometry::CameraKind::kPinhole, 150, 100, 120.0, 120.0, 74.5, 49.5, {}};
  const auto projected = project(core::Backend::kCpu, spans_of(cloud), *View::from(model, {}), {});
  ASSERT_TRUE(projected);
  const TileLists lists = make_tile_lists(projected->splats, 150, 100);
  EXPECT_EQ(lists.columns, 5);
  EXPECT_EQ(lists.rows, 7);
  std::size_t needed = 0;
  for (int row = 0; row < lists.rows; ++row) {
    for (int column = 0; column < lists.columns; ++column) {
      const auto tile = lists.tile(row * lists.columns + column);
      EXPECT_TRUE(std::ranges::is_sorted(tile, {}, &TileEntry::splat)) << "nearest first";
      for (std::uint32_t i = 0; i < projected->splats.size(); ++i) {
        if (!reaches_tile(projected->splats[i], column, row)) continue;
        ++needed;
        EXPECT_TRUE(std::ranges::binary_search(tile, i, {}, &TileEntry::splat)) << "splat " << i;
      }
    }
  }
  // The test is exact for the tile's area; what is left over touches it between pixel centres only.
  EXPECT_LT(static_cast<double>(lists.entries.size()), 1.15 * static_cast<double>(needed));
}

TEST(TileLists, NoSplatsNoPairs) {
  const TileLists lists = make_tile_lists({}, 33, 16);
  EXPECT_EQ(lists.columns, 2);
  EXPECT_TRUE(lists.tile(1).empty());
}

}  // namespace
}  // namespace edgesplat::splat
