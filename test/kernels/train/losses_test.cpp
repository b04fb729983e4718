// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/losses.hpp"

#include "kernels/train/image_measures.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace edgesplat::train {
namespace {

std::vector<float> noise(std::uint64_t seed, std::size_t count, double low = 0.0, double high = 1.0) {
  test::Random random(seed);
  std::vector<float> values(count);
  for (float& value : values) value = static_cast<float>(random.uniform(low, high));
  return values;
}

TEST(ColourLoss, MixesL1AndDissimilarity) {
  const auto drawn = noise(1, 3 * 24 * 16), target = noise(2, 3 * 24 * 16);
  const ColourPair pair{24, 16, drawn, target, {}};
  std::vector<float> by_drawn(drawn.size(), 99.0F);
  double l1 = 0.0;
  for (std::size_t i = 0; i < drawn.size(); ++i) l1 += std::abs(static_cast<double>(drawn[i] - target[i]));
  l1 /= static_cast<double>(drawn.size());
  const ColourLoss loss = colour_loss(pair, 0.2F, by_drawn);
  EXPECT_NEAR(loss.l1, l1, 1e-6);
  EXPECT_NEAR(loss.value, 0.8 * l1 + 0.2 * (1.0 - ssim(pair)), 1e-6);
}

TEST(ColourLoss, GradientAgreesWithDifferences) {
  auto drawn = noise(3, 3 * 24 * 16);
  const auto target = noise(4, 3 * 24 * 16), weight = noise(5, 24 * 16);
  const ColourPair pair{24, 16, drawn, target, weight};
  std::vector<float> by_drawn(drawn.size()), ignored(drawn.size());
  colour_loss(pair, 0.3F, by_drawn);
  for (std::size_t i = 0; i < drawn.size(); i += 37) {
    if (std::abs(drawn[i] - target[i]) < 0.02F) continue;  // at the kink of L1
    constexpr float kStep = 0.01F;
    const float before = drawn[i];
    drawn[i] = before + kStep;
    const double above = colour_loss(pair, 0.3F, ignored).value;
    drawn[i] = before - kStep;
    const double below = colour_loss(pair, 0.3F, ignored).value;
    drawn[i] = before;
    const double expected = (above - below) / 0.02;
    EXPECT_NEAR(static_cast<double>(by_drawn[i]), expected, 0.02 * std::abs(expected) + 1e-5);
  }
}

TEST(ColourLoss, IsZeroWhereNothingCounts) {
  const auto drawn = noise(6, 3 * 64), target = noise(7, 3 * 64);
  const std::vector<float> weight(64, 0.0F);
  std::vector<float> by_drawn(drawn.size(), 99.0F);
  EXPECT_EQ(colour_loss({8, 8, drawn, target, weight}, 0.2F, by_drawn).value, 0.0);
  for (const float g : by_drawn) EXPECT_EQ(g, 0.0F);
}

TEST(DepthLoss, GradientAgreesWithDifferencesWhereThereIsAMeasurement) {
  auto depth_sum = noise(8, 100, 1.0, 3.0), alpha = noise(9, 100, 0.6, 1.0);
  auto target = noise(10, 100, 1.0, 6.0);
  for (std::size_t i = 0; i < 100; i += 4) target[i] = 0.0F;
  target[1] = std::numeric_limits<float>::quiet_NaN();
  alpha[2] = 0.1F;  // hardly covered
  std::vector<float> by_depth(100), by_alpha(100), ignored(100), also_ignored(100);
  const auto loss = [&](std::span<float> d, std::span<float> a) {
    return depth_loss({depth_sum, alpha, target, {}}, 2.0F, 0.5F, d, a);
  };
  EXPECT_GT(loss(by_depth, by_alpha), 0.0);
  for (std::size_t i = 0; i < 100; ++i) {
    const auto difference = [&](float& value) {
      const float before = value;
      value = before + 0.001F;
      const double above = loss(ignored, also_ignored);
      value = before - 0.001F;
      const double below = loss(ignored, also_ignored);
      value = before;
      return 2.0 * (above - below) / 0.002;
    };
    if (i % 4 == 0 || i == 1 || i == 2) {
      EXPECT_EQ(by_depth[i], 0.0F);
      EXPECT_EQ(by_alpha[i], 0.0F);
      continue;
    }
    EXPECT_NEAR(static_cast<double>(by_depth[i]), difference(depth_sum[i]), 1e-3);
    EXPECT_NEAR(static_cast<double>(by_alpha[i]), difference(alpha[i]), 2e-3);
  }
}

TEST(GapLoss, IsTheOpenShareOfWhatCountsAndAddsItsSlope) {
  const std::vector<float> alpha = {1.0F, 0.25F, 0.5F, 0.0F};
  const std::vector<float> weight = {1.0F, 1.0F, 0.0F, 2.0F};
  std::vector<float> by_alpha = {0.5F, 0.0F, 0.0F, 0.0F};
  EXPECT_NEAR(add_gap_loss(alpha, weight, 0.4F, by_alpha), (0.0 + 0.75 + 2.0) / 4.0, 1e-6);
  EXPECT_NEAR(by_alpha[0], 0.5F - 0.1F, 1e-6F) << "what was there stays";
  EXPECT_NEAR(by_alpha[1], -0.1F, 1e-6F);
  EXPECT_EQ(by_alpha[2], 0.0F);
  EXPECT_NEAR(by_alpha[3], -0.2F, 1e-6F);
  by_alpha.assign(4, 0.0F);
  EXPECT_NEAR(add_gap_loss(alpha, {}, 1.0F, by_alpha), 2.25 / 4.0, 1e-6);
  EXPECT_NEAR(by_alpha[2], -0.25F, 1e-6F);
  const std::vector<float> nothing(4, 0.0F);
  EXPECT_EQ(add_gap_loss(alpha, nothing, 1.0F, by_alpha), 0.0);
}

TEST(Psnr, OfAKnownDifference) {
  const std::vector<float> target(300, 0.5F), drawn(300, 0.6F);
  EXPECT_NEAR(psnr_db({10, 10, drawn, target, {}}), 20.0, 1e-4);
  EXPECT_EQ(psnr_db({10, 10, target, target, {}}), 100.0);
  std::vector<float> weight(100, 1.0F), half = target;
  half[0] = 1.0F;
  weight[0] = 0.0F;
  EXPECT_EQ(psnr_db({10, 10, half, target, weight}), 100.0) << "the only different pixel does not count";
}

TEST(Psnr, CutsDrawnValuesAsAScreenDoes) {
  const std::vector<float> target(300, 1.0F), drawn(300, 7.0F);
  EXPECT_EQ(psnr_db({10, 10, drawn, target, {}}), 100.0);
}

}  // namespace
}  // namespace edgesplat::train
