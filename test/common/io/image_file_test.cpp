// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/image_file.hpp"

#include "common/io/atomic_file.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace edgesplat::io {
namespace {

using sensor::ImageGray16;
using sensor::ImageGray8;
using sensor::ImageRgb8;

template <typename Image>
Image make_noise(int width, int height) {
  Image image(width, height);
  std::mt19937 random(3);
  for (auto& value : image.values) value = static_cast<std::remove_reference_t<decltype(value)>>(random());
  return image;
}

ImageRgb8 make_gradient(int width, int height) {
  ImageRgb8 image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      auto* pixel = image.pixel(x, y);
      pixel[0] = static_cast<std::uint8_t>(x * 255 / width);
      pixel[1] = static_cast<std::uint8_t>(y * 255 / height);
      pixel[2] = 128;
    }
  }
  return image;
}

template <typename Image>
class PngTest : public ::testing::Test {};
using PngTypes = ::testing::Types<ImageGray8, ImageGray16, ImageRgb8>;
TYPED_TEST_SUITE(PngTest, PngTypes);

TYPED_TEST(PngTest, IsLossless) {
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 5}, {64, 33}}) {
    const auto image = make_noise<TypeParam>(width, height);
    for (const int level : {1, 9}) {
      const auto bytes = encode_png(image, level);
      ASSERT_TRUE(bytes);
      const auto decoded = decode_image(*bytes);
      ASSERT_TRUE(decoded) << decoded.error().context;
      const auto* typed = std::get_if<TypeParam>(&*decoded);
      ASSERT_NE(typed, nullptr);
      EXPECT_EQ(typed->width_px, width);
      EXPECT_EQ(typed->height_px, height);
      EXPECT_EQ(typed->values, image.values);
    }
  }
}

TEST(Png, DepthIsStoredBigEndian) {
  ImageGray16 image(1, 1);
  image.values = {0x1234};
  const auto bytes = encode_png(image).value();
  EXPECT_EQ(decode_gray16(bytes).value().values[0], 0x1234);
  EXPECT_EQ(decode_rgb8(bytes).value().values[0], 0x12);  // the upper byte
  EXPECT_FALSE(decode_gray8(bytes));
}

TEST(Jpeg, KeepsASmoothPicture) {
  const auto image = make_gradient(97, 61);
  const auto bytes = encode_jpeg(image, 95);
  ASSERT_TRUE(bytes);
  const auto decoded = decode_rgb8(*bytes);
  ASSERT_TRUE(decoded);
  ASSERT_EQ(decoded->values.size(), image.values.size());
  double squared = 0.0;
  for (std::size_t i = 0; i < image.values.size(); ++i)
    squared += std::pow(image.values[i] - decoded->values[i], 2);
  EXPECT_LT(std::sqrt(squared / static_cast<double>(image.values.size())), 2.0);
}

TEST(Jpeg, GreyStaysGrey) {
  const ImageGray8 image(16, 8, 77);
  const auto bytes = encode_jpeg(image).value();
  const auto decoded = decode_gray8(bytes);
  ASSERT_TRUE(decoded);
  EXPECT_NEAR(decoded->values[0], 77, 1);
  EXPECT_NEAR(decode_rgb8(bytes).value().pixel(3, 3)[2], 77, 1);
}

TEST(ImageFile, HeaderWithoutDecoding) {
  const auto jpeg = read_image_header(encode_jpeg(make_gradient(40, 30)).value());
  ASSERT_TRUE(jpeg);
  EXPECT_EQ(jpeg->format, ImageFormat::kJpeg);
  EXPECT_EQ(jpeg->width_px, 40);
  const auto png = read_image_header(encode_png(make_gradient(40, 30)).value());
  ASSERT_TRUE(png);
  EXPECT_EQ(png->format, ImageFormat::kPng);
  EXPECT_EQ(png->height_px, 30);
}

TEST(ImageFile, SavesAndLoadsByExtension) {
  const test::TempDir folder;
  const auto image = make_gradient(32, 16);
  for (const char* name : {"a.png", "b.JPG", "c.jpeg"}) {
    ASSERT_TRUE(save_image(folder / name, image));
    EXPECT_EQ(load_rgb8(folder / name).value().width_px, 32) << name;
  }
  EXPECT_EQ(load_rgb8(folder / "a.png").value().values, image.values);
  EXPECT_EQ(save_image(folder / "a.bmp", image).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(save_image(folder / "a.jpg", ImageGray16(2, 2)).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(load_image(folder / "none.png").error().code, Errc::kNotFound);
  ASSERT_TRUE(write_file_atomically(folder / "bad.png", "not a picture"));
  EXPECT_THAT(load_image(folder / "bad.png").error().context,
              ::testing::HasSubstr("bad.png: neither JPEG nor PNG"));
}

TEST(ImageFile, RefusesPicturesThatMakeNoSense) {
  EXPECT_FALSE(encode_png(ImageRgb8{}));
  EXPECT_FALSE(encode_jpeg(ImageGray8{}));
  EXPECT_FALSE(encode_jpeg(ImageRgb8(2, 2), 0));
  EXPECT_FALSE(encode_png(ImageGray8(2, 2), 10));
  EXPECT_FALSE(encode_png(ImageGray8(kMaxImageSide_px + 1, 1)));
  ImageRgb8 inconsistent(4, 4);
  inconsistent.values.resize(3);
  EXPECT_EQ(encode_png(inconsistent).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(encode_jpeg(inconsistent).error().code, Errc::kInvalidArgument);
}

TEST(ImageHostile, EveryTruncationIsRefused) {
  for (const auto& bytes :
       {encode_png(make_noise<ImageRgb8>(9, 9)).value(), encode_jpeg(make_gradient(24, 24)).value()}) {
    // The last bytes (an end marker) may be missing without losing a pixel.
    for (std::size_t length = 0; length + 16 < bytes.size(); ++length) {
      const auto decoded = decode_image(std::span(bytes).first(length));
      ASSERT_FALSE(decoded) << length << " of " << bytes.size();
      ASSERT_EQ(decoded.error().code, Errc::kCorrupt);
    }
  }
}

TEST(ImageHostile, RandomDamageIsSurvived) {
  std::mt19937 random(5);
  for (const auto& bytes :
       {encode_png(make_gradient(31, 17)).value(), encode_jpeg(make_gradient(31, 17)).value(),
        encode_png(make_noise<ImageGray16>(12, 12)).value()}) {
    for (int round = 0; round < 2000; ++round) {
      auto damaged = bytes;
      for (int i = 0; i < 3; ++i) damaged[random() % damaged.size()] = static_cast<std::byte>(random());
      (void)decode_image(damaged);
      (void)read_image_header(damaged);
    }
  }
}

TEST(ImageHostile, AbsurdSizesAreRefusedBeforeMemoryIsTaken) {
  auto png = encode_png(ImageGray8(4, 4)).value();
  png[16 + 2] = std::byte{0x40};  // width 0x4004: beyond the limit
  EXPECT_FALSE(decode_image(png));
  auto jpeg = encode_jpeg(ImageGray8(4, 4)).value();
  for (std::size_t i = 0; i + 8 < jpeg.size(); ++i) {
    if (jpeg[i] != std::byte{0xFF} || jpeg[i + 1] != std::byte{0xC0}) continue;
    jpeg[i + 5] = jpeg[i + 7] = std::byte{0x3F};  // 16132 x 16132 pixels in a few hundred bytes
  }
  const auto decoded = decode_image(jpeg);
  ASSERT_FALSE(decoded);
  EXPECT_THAT(decoded.error().context, ::testing::HasSubstr("more pixels than its bytes can hold"));
}

}  // namespace
}  // namespace edgesplat::io
