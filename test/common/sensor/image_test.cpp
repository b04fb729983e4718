// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/sensor/image.hpp"

#include <gtest/gtest.h>

namespace edgesplat::sensor {
namespace {

TEST(Image, IsRowMajorAndInterleaved) {
  ImageRgb8 image(4, 3, 7);
  EXPECT_EQ(image.values.size(), 36U);
  image.pixel(1, 2)[2] = 99;
  EXPECT_EQ(image.values[(2 * 4 + 1) * 3 + 2], 99);
  EXPECT_EQ(image.pixel(0, 0)[0], 7);
}

TEST(Image, DefaultIsEmpty) {
  EXPECT_TRUE(ImageF32().empty());
  EXPECT_TRUE(ImageF32(0, 5).empty());
  EXPECT_FALSE(ImageF32(1, 1).empty());
}

}  // namespace
}  // namespace edgesplat::sensor
