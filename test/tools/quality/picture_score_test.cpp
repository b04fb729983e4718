// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/quality/picture_score.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace edgesplat::quality {
namespace {

TEST(PictureScore, IsTheFormulaForAnEvenDifference) {
  const sensor::ImageRgb8 target(40, 30, 100);
  const sensor::ImageRgb8 drawn(40, 30, 110);
  const PictureScore score = *score_picture(drawn, target, {}, nullptr);
  EXPECT_NEAR(score.psnr_db, 20.0 * std::log10(255.0 / 10.0), 1e-4);
  EXPECT_GT(score.ssim, 0.98);  // flat pictures have one structure
  EXPECT_LT(score.ssim, 1.0);
}

TEST(PictureScore, CountsOnlyWhatHasWeight) {
  const sensor::ImageRgb8 target(40, 30, 100);
  sensor::ImageRgb8 drawn = target;
  std::vector<float> weight(40 * 30, 1.0F);
  for (int x = 0; x < 40; ++x) {
    drawn.pixel(x, 0)[0] = 255;
    weight[static_cast<std::size_t>(x)] = 0.0F;
  }
  EXPECT_LT(score_picture(drawn, target, {}, nullptr)->psnr_db, 40.0);
  EXPECT_EQ(score_picture(drawn, target, weight, nullptr)->psnr_db, 100.0);
}

TEST(PictureScore, SizesMustAgree) {
  const sensor::ImageRgb8 a(32, 24), b(24, 32);
  EXPECT_EQ(score_picture(a, b, {}, nullptr).error().code, Errc::kInvalidArgument);
  const std::vector<float> weight(5);
  EXPECT_EQ(score_picture(a, a, weight, nullptr).error().code, Errc::kInvalidArgument);
}

}  // namespace
}  // namespace edgesplat::quality
