// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/gaussian_brightness.hpp"

#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace edgesplat::tracking {
namespace {

struct Pair {
  std::vector<GaussianPixel> pixels;
  std::vector<float> seen;
};

/// Every `wrong`-th pixel shows something else, and every tenth is out of the picture.
Pair seen_as(double gain, double offset, int wrong) {
  test::Random random(7);
  Pair pair;
  for (int i = 0; i < 2000; ++i) {
    const double map = random.uniform(20.0, 200.0);
    pair.pixels.push_back(
        {Eigen::Vector3f::UnitZ(), static_cast<float>(map), Eigen::Matrix<float, 6, 1>::Zero()});
    const bool is_wrong = wrong > 0 && i % wrong == 0;
    const double value = is_wrong ? 250.0 : gain * map + offset + 3.0 * random.normal();
    pair.seen.push_back(i % 10 == 9 ? -1.0F : static_cast<float>(value));
  }
  return pair;
}

TEST(GaussianBrightness, FindsGainAndOffsetAmongOutliers) {
  const Pair clean = seen_as(0.7, 12.0, 0);
  EXPECT_NEAR(guess_brightness(clean.pixels, clean.seen).gain, 0.7, 0.01);
  EXPECT_NEAR(guess_brightness(clean.pixels, clean.seen).offset, 12.0, 1.0);
  const Pair mixed = seen_as(0.7, 12.0, 12);
  EXPECT_NEAR(guess_brightness(mixed.pixels, mixed.seen).gain, 0.7, 0.02);
  EXPECT_NEAR(guess_brightness(mixed.pixels, mixed.seen).offset, 12.0, 2.0);
}

TEST(GaussianBrightness, NoiseIsThatOfTheMany) {
  const Pair mixed = seen_as(1.0, 0.0, 7);
  EXPECT_NEAR(residual_noise_grey(mixed.pixels, mixed.seen, {}), 3.0, 0.7);
  EXPECT_EQ(residual_noise_grey({}, {}, {}), 2.0);
}

TEST(GaussianBrightness, AWrongMapForetellsNoMoreThanChance) {
  const Pair right = seen_as(1.0, 0.0, 0);
  EXPECT_GT(how_foretold(right.pixels, right.seen, guess_brightness(right.pixels, right.seen)).explained,
            0.99);
  Pair wrong = right;
  std::reverse(wrong.seen.begin(), wrong.seen.end());
  const Foretold by_chance =
      how_foretold(wrong.pixels, wrong.seen, guess_brightness(wrong.pixels, wrong.seen));
  EXPECT_LT(by_chance.explained, 0.5);
  EXPECT_NEAR(by_chance.spread_grey, 180.0 / std::sqrt(12.0), 3.0);
}

TEST(GaussianBrightness, NothingSeenIsNothingForetold) {
  const std::vector<GaussianPixel> pixels(5);
  const std::vector<float> seen(5, -1.0F);
  EXPECT_EQ(guess_brightness(pixels, seen).gain, 1.0);
  EXPECT_EQ(how_foretold(pixels, seen, {}).explained, 0.0);
  EXPECT_EQ(guess_brightness({}, {}).offset, 0.0);
}

}  // namespace
}  // namespace edgesplat::tracking
