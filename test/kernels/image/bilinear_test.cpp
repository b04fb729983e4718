// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/image/bilinear.hpp"

#include <gtest/gtest.h>

namespace edgesplat::image {
namespace {

/// 3 x 2 pixels: 10 20 70 over 50 80 30.
sensor::ImageGray8 small_picture() {
  sensor::ImageGray8 picture(3, 2);
  picture.values = {10, 20, 70, 50, 80, 30};
  return picture;
}

TEST(Bilinear, APixelIsItself) {
  const sensor::ImageGray8 picture = small_picture();
  EXPECT_EQ(bilinear(picture, 0, 0, 0.0F, 0.0F), 10.0F);
  EXPECT_EQ(bilinear(picture, 1, 0, 0.0F, 0.0F), 20.0F);
}

TEST(Bilinear, BetweenPixelsItIsLinearAlongEachAxis) {
  const sensor::ImageGray8 picture = small_picture();
  EXPECT_FLOAT_EQ(bilinear(picture, 0, 0, 0.25F, 0.0F), 12.5F);
  EXPECT_FLOAT_EQ(bilinear(picture, 0, 0, 0.0F, 0.75F), 40.0F);
  // (20 + 70) / 2 = 45 above, (80 + 30) / 2 = 55 below.
  EXPECT_FLOAT_EQ(bilinear(picture, 1, 0, 0.5F, 0.5F), 50.0F);
}

}  // namespace
}  // namespace edgesplat::image
