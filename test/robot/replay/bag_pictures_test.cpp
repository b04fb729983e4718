// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/bag_pictures.hpp"

#include "common/io/image_file.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace edgesplat::replay {
namespace {

constexpr std::array<std::uint8_t, 3> kColour{200, 90, 30};  // red, green, blue

/// 8x6 pixels of one colour, each row padded by 3 bytes.
struct Plain {
  std::vector<std::byte> bytes;
  std::uint32_t step;
};
template <typename F>
Plain plain(int channels, const F& value) {
  Plain out{{}, static_cast<std::uint32_t>(8 * channels + 3)};
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x)
      for (int c = 0; c < channels; ++c) out.bytes.push_back(static_cast<std::byte>(value(x, y, c)));
    for (int i = 0; i < 3; ++i) out.bytes.push_back(std::byte{0xEE});
  }
  return out;
}

io::RosImage message(const char* encoding, const Plain& pixels) {
  io::RosImage image;
  image.width_px = 8;
  image.height_px = 6;
  image.encoding = encoding;
  image.step_bytes = pixels.step;
  image.data = pixels.bytes;
  return image;
}

void expect_colour(const Result<sensor::ImageRgb8>& picture, std::array<std::uint8_t, 3> colour,
                   const char* what) {
  ASSERT_TRUE(picture) << picture.error().context;
  ASSERT_EQ(picture->width_px, 8);
  ASSERT_EQ(picture->height_px, 6);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x)
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(int{picture->pixel(x, y)[c]}, int{colour[static_cast<std::size_t>(c)]})
            << what << x << "," << y;
}

TEST(BagPictures, ColourWhateverItsOrder) {
  for (const auto& [encoding, order] :
       std::vector<std::pair<const char*, std::vector<std::size_t>>>{{"rgb8", {0, 1, 2}},
                                                                     {"bgr8", {2, 1, 0}},
                                                                     {"8UC3", {2, 1, 0}},
                                                                     {"rgba8", {0, 1, 2, 0}},
                                                                     {"bgra8", {2, 1, 0, 1}}}) {
    const auto pixels = plain(static_cast<int>(order.size()), [&](int, int, int c) {
      return kColour.at(order.at(static_cast<std::size_t>(c)));
    });
    expect_colour(picture_of(message(encoding, pixels)), kColour, encoding);
  }
  expect_colour(picture_of(message("mono8", plain(1, [](int, int, int) { return 70; }))), {70, 70, 70},
                "mono8");
}

/// Where each mosaic has red (0), green (1) and blue (2): rows of the name.
int mosaic_colour(const char* name, int x, int y) {
  const char letter = name[6 + (y % 2) * 2 + x % 2];
  return letter == 'r' ? 0 : (letter == 'g' ? 1 : 2);
}

TEST(BagPictures, MosaicsOfOneColourGiveThatColour) {
  for (const char* encoding : {"bayer_rggb8", "bayer_bggr8", "bayer_gbrg8", "bayer_grbg8"}) {
    const auto pixels = plain(1, [&](int x, int y, int) {
      return kColour.at(static_cast<std::size_t>(mosaic_colour(encoding, x, y)));
    });
    expect_colour(picture_of(message(encoding, pixels)), kColour, encoding);
  }
}

TEST(BagPictures, WhatDoesNotFitIsRefused) {
  const auto pixels = plain(3, [](int, int, int) { return 1; });
  auto image = message("rgb8", pixels);
  image.height_px = 7;
  EXPECT_FALSE(picture_of(image));
  image = message("rgb8", pixels);
  image.step_bytes = 23;
  EXPECT_FALSE(picture_of(image));
  image = message("rgb8", pixels);
  image.step_bytes = 0xFFFF'FFFF;
  EXPECT_FALSE(picture_of(image));
  image = message("rgb8", pixels);
  image.width_px = 0;
  EXPECT_FALSE(picture_of(image));
  image.width_px = 0xFFFF'FFFF;
  EXPECT_FALSE(picture_of(image));
  const auto other = picture_of(message("32FC1", pixels));
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().context.find("32FC1"), std::string::npos);
  // The last row needs no padding.
  image = message("rgb8", pixels);
  image.data = image.data.first(image.data.size() - 3);
  EXPECT_TRUE(picture_of(image));
}

TEST(BagPictures, CompressedPictures) {
  sensor::ImageRgb8 colour(8, 6);
  for (std::size_t i = 0; i < colour.values.size(); ++i) colour.values[i] = kColour.at(i % 3);
  const auto png = io::encode_png(colour).value();
  io::RosCompressedImage image;
  image.format = "bgr8; png compressed bgr8";
  image.data = png;
  expect_colour(picture_of(image), kColour, "png");
  sensor::ImageGray8 mosaic(8, 6);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x)
      *mosaic.pixel(x, y) = kColour.at(static_cast<std::size_t>(mosaic_colour("bayer_grbg8", x, y)));
  const auto mosaic_png = io::encode_png(mosaic).value();
  image.format = "bayer_grbg8; png compressed";
  image.data = mosaic_png;
  expect_colour(picture_of(image), kColour, "mosaic");
  image.data = image.data.first(20);
  EXPECT_FALSE(picture_of(image));
}

}  // namespace
}  // namespace edgesplat::replay
