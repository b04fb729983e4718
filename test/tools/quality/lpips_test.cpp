// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/quality/lpips.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace edgesplat::quality {
namespace {

const std::filesystem::path kModel = EDGESPLAT_SOURCE_DIR "/../shared/models/lpips_alex";

sensor::ImageRgb8 pattern(int width_px, int height_px) {
  sensor::ImageRgb8 picture(width_px, height_px);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const double wave = std::sin(0.2 * x) + std::cos(0.13 * y) + std::sin(0.05 * (x + y));
      for (int c = 0; c < 3; ++c)
        picture.pixel(x, y)[c] = static_cast<std::uint8_t>(128 + 30 * wave + 10 * c);
    }
  }
  return picture;
}

sensor::ImageRgb8 noisy(sensor::ImageRgb8 picture, int amplitude) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> noise(-amplitude, amplitude);
  for (std::uint8_t& value : picture.values) {
    value = static_cast<std::uint8_t>(std::clamp(int{value} + noise(random), 0, 255));
  }
  return picture;
}

TEST(Lpips, IsZeroForEqualAndGrowsWithNoise) {
  if (!std::filesystem::exists(kModel)) GTEST_SKIP() << kModel << " is absent";
  auto lpips = Lpips::load(kModel);
  ASSERT_TRUE(lpips) << lpips.error().context;
  const auto picture = pattern(256, 256);
  EXPECT_NEAR(lpips->distance(picture, picture).value(), 0.0, 1e-9);
  const double little = lpips->distance(picture, noisy(picture, 10)).value();
  const double much = lpips->distance(picture, noisy(picture, 80)).value();
  EXPECT_GT(little, 0.001);
  EXPECT_GT(much, 2.0 * little);
  EXPECT_LT(much, 2.0);
  EXPECT_NEAR(lpips->distance(noisy(picture, 80), picture).value(), much, 1e-6);
}

TEST(Lpips, TakesPicturesOfAnySize) {
  if (!std::filesystem::exists(kModel)) GTEST_SKIP() << kModel << " is absent";
  auto lpips = Lpips::load(kModel);
  ASSERT_TRUE(lpips) << lpips.error().context;
  const auto square = pattern(256, 256), wide = pattern(512, 256);
  // The same noise in the same kind of picture is as far in a picture twice as wide.
  EXPECT_NEAR(lpips->distance(wide, noisy(wide, 40)).value(),
              lpips->distance(square, noisy(square, 40)).value(), 0.05);
  EXPECT_EQ(lpips->distance(square, wide).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(lpips->distance(pattern(32, 256), pattern(32, 256)).error().code, Errc::kInvalidArgument);
}

TEST(Lpips, AMissingNetworkIsNotFound) {
  EXPECT_EQ(Lpips::load("/nonexistent").error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace edgesplat::quality
