// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/tile_reach.hpp"

#include "kernels/splat/blend_math.hpp"
#include "test/support/random_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace edgesplat::splat {
namespace {

constexpr int kWidth_px = 150, kHeight_px = 100, kColumns = 10, kRows = 7;

bool reaches(const Splat& s, int left, int top, int right, int bottom) {
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const double dx = static_cast<double>(x) - s.u_px, dy = static_cast<double>(y) - s.v_px;
      const double power =
          -0.5 * (s.conic[0] * dx * dx + s.conic[2] * dy * dy) - static_cast<double>(s.conic[1]) * dx * dy;
      if (s.opacity * std::exp(power) >= kMinAlpha) return true;
    }
  }
  return false;
}

std::vector<Splat> splats() {
  test::Random random(21);
  auto cloud = test::random_cloud(random, {.count = 600, .half_width_m = 6.0, .scale_max_m = 1.5});
  for (std::size_t i = 0; i < 200; ++i)  // needles
    cloud.log_scales[3 * i] = cloud.log_scales[3 * i + 1] = -10.0F;
  const geometry::CameraModel model{
      geometry::CameraKind::kPinhole, kWidth_px, kHeight_px, 120.0, 120.0, 74.5, 49.5, {}};
  return project(core::Backend::kCpu, spans_of(cloud), *View::from(model, {}), {})->splats;
}

TEST(TileReach, HoldsEveryTileThatTheSplatReachesAndFewMore) {
  std::size_t needed = 0, given = 0;
  for (const Splat& s : splats()) {
    const TileInterval rows = rows_reached(s, kRows);
    unsigned long long count = 0;
    for (int row = 0; row < kRows; ++row) {
      const TileInterval columns = columns_reached(s, row, kColumns);
      for (int column = 0; column < kColumns; ++column) {
        const bool held =
            row >= rows.first && row < rows.last && column >= columns.first && column < columns.last;
        const bool must = reaches(s, 16 * column, 16 * row, 16 * column + 15, 16 * row + 15);
        ASSERT_TRUE(held || !must) << "splat " << s.gaussian << " tile " << column << ' ' << row;
        count += held ? 1U : 0U;
        needed += must ? 1U : 0U;
      }
    }
    EXPECT_EQ(tiles_reached(s, kColumns, kRows), count);
    given += count;
  }
  EXPECT_GT(needed, 1000U);
  // What is left over touches the tile between its pixel centres.
  EXPECT_LT(static_cast<double>(given), 1.15 * static_cast<double>(needed));
}

TEST(TileReach, ARectangleOfPixelsIsReachedWhereAPixelIs) {
  std::size_t needed = 0, given = 0;
  for (const Splat& s : splats()) {
    const BlendRecord record = blend_record(s);
    for (int top = 0; top < kHeight_px; top += 4) {
      for (int left = 0; left < kWidth_px; left += 8) {
        const bool held =
            reaches_rectangle(record, static_cast<float>(left), static_cast<float>(top), 7.0F, 3.0F);
        const bool must = reaches(s, left, top, left + 7, top + 3);
        ASSERT_TRUE(held || !must) << "splat " << s.gaussian << " at " << left << ' ' << top;
        needed += must ? 1U : 0U;
        given += held ? 1U : 0U;
      }
    }
  }
  EXPECT_LT(static_cast<double>(given), 1.3 * static_cast<double>(needed));
}

TEST(TileReach, WhatIsNotANumberDoesNotBound) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(tiles_between(nan, nan, 7).last, 7);
  EXPECT_EQ(tiles_between(-inf, inf, 7).last, 7);
  EXPECT_EQ(tiles_between(-1e30F, 1e30F, 7).first, 0);
  EXPECT_EQ(tiles_between(inf, inf, 7).last, 0);
  EXPECT_EQ(tiles_between(16.2F, 30.0F, 7).first, 1);
  EXPECT_EQ(tiles_between(16.2F, 30.0F, 7).last, 2);
  EXPECT_EQ(tiles_between(15.2F, 15.8F, 7).last, 0) << "between the centres of two tiles' pixels";
  EXPECT_EQ(tiles_between(112.0F, 200.0F, 7).last, 0);
}

TEST(BlendMath, APixelBecomesFullAndTakesNoMore) {
  Splat splat{};
  splat.conic[0] = splat.conic[2] = 0.1F;
  splat.opacity = 0.8F;
  splat.reach2 = 2.0F * std::log(255.0F * 0.8F);
  splat.rgb[0] = 1.0F;
  splat.depth_m = 2.0F;
  const BlendRecord record = blend_record(splat);
  BlendPixel pixel;
  double expected = 0.0, left = 1.0;
  for (int i = 0; i < 10; ++i) {
    blend_into(record, 0.0F, 0.0F, pixel);
    if (left * 0.2 < 1e-4) continue;
    expected += 0.8 * left;
    left *= 0.2;
  }
  EXPECT_NEAR(pixel.rgb[0], expected, 1e-5);
  EXPECT_NEAR(pixel.depth_m, 2.0 * expected, 1e-5);
  EXPECT_TRUE(pixel.full);
  EXPECT_NEAR(pixel.transmittance, 3.2e-4, 1e-6);
}

}  // namespace
}  // namespace edgesplat::splat
