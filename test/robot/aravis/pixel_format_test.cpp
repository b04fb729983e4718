// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/pixel_format.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace edgesplat::aravis {
namespace {

TEST(PixelFormat, CodesAreThoseOfTheNamingConvention) {
  EXPECT_EQ(pixel_format_of(0x01080001), PixelFormat::kMono8);
  EXPECT_EQ(pixel_format_of(0x01080009), PixelFormat::kBayerRg8);
  EXPECT_EQ(pixel_format_of(0x02180014), PixelFormat::kRgb8);
  EXPECT_EQ(pixel_format_of(0x0108000B), std::nullopt);  // BayerBG8
}

TEST(PixelFormat, GreyIsRepeatedAndColourIsCopied) {
  const std::array grey{std::byte{1}, std::byte{2}, std::byte{3}, std::byte{250}};
  const auto from_grey = to_rgb8(PixelFormat::kMono8, 2, 2, grey);
  ASSERT_TRUE(from_grey.has_value());
  EXPECT_EQ(from_grey->values, (std::vector<std::uint8_t>{1, 1, 1, 2, 2, 2, 3, 3, 3, 250, 250, 250}));
  std::vector<std::byte> colour(12);
  for (std::size_t i = 0; i < colour.size(); ++i) colour[i] = static_cast<std::byte>(20 * i);
  const auto from_colour = to_rgb8(PixelFormat::kRgb8, 2, 2, colour);
  ASSERT_TRUE(from_colour.has_value());
  for (std::size_t i = 0; i < colour.size(); ++i) EXPECT_EQ(from_colour->values[i], 20 * i);
}

TEST(PixelFormat, AMosaicOfOneColourGivesThatColourEverywhere) {
  constexpr int kWidth = 12, kHeight = 10;
  constexpr std::array<int, 3> kColour{200, 120, 30};
  std::vector<std::byte> mosaic;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool red = y % 2 == 0 && x % 2 == 0, blue = y % 2 == 1 && x % 2 == 1;
      mosaic.push_back(static_cast<std::byte>(red ? kColour[0] : blue ? kColour[2] : kColour[1]));
    }
  const auto image = to_rgb8(PixelFormat::kBayerRg8, kWidth, kHeight, mosaic);
  ASSERT_TRUE(image.has_value());
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) EXPECT_EQ(image->pixel(x, y)[c], kColour.at(static_cast<std::size_t>(c)));
}

TEST(PixelFormat, AMosaicOfAGradientIsInterpolatedToTheGradient) {
  constexpr int kSide = 16;
  const auto red = [](int x, int y) { return 4 * x + 6 * y; };
  const auto green = [](int x, int y) { return 200 - 4 * x - 2 * y; };
  const auto blue = [](int x, int y) { return 50 + 2 * x + 4 * y; };
  std::vector<std::byte> mosaic;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const int value =
          y % 2 == 0 ? (x % 2 == 0 ? red(x, y) : green(x, y)) : (x % 2 == 0 ? green(x, y) : blue(x, y));
      mosaic.push_back(static_cast<std::byte>(value));
    }
  const auto image = to_rgb8(PixelFormat::kBayerRg8, kSide, kSide, mosaic);
  ASSERT_TRUE(image.has_value());
  for (int y = 1; y < kSide - 1; ++y)  // the border has neighbours on one side only
    for (int x = 1; x < kSide - 1; ++x) {
      EXPECT_NEAR(image->pixel(x, y)[0], red(x, y), 1) << x << " " << y;
      EXPECT_NEAR(image->pixel(x, y)[1], green(x, y), 1) << x << " " << y;
      EXPECT_NEAR(image->pixel(x, y)[2], blue(x, y), 1) << x << " " << y;
    }
}

TEST(PixelFormat, ImpossibleSizesAreRefused) {
  const std::vector<std::byte> bytes(64);
  for (const auto& [width, height] :
       {std::pair{0, 8}, {8, 0}, {-1, 8}, {1, 8}, {9, 8}, {16385, 2}, {2'000'000'000, 2}}) {
    const auto image = to_rgb8(PixelFormat::kMono8, width, height, bytes);
    ASSERT_FALSE(image.has_value()) << width << "x" << height;
    EXPECT_EQ(image.error().code, Errc::kBadPacket);
  }
  EXPECT_TRUE(to_rgb8(PixelFormat::kMono8, 8, 8, bytes).has_value());
  EXPECT_FALSE(to_rgb8(PixelFormat::kRgb8, 8, 8, bytes).has_value());
}

}  // namespace
}  // namespace edgesplat::aravis
