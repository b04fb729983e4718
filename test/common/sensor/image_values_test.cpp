// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/sensor/image_values.hpp"

#include <gtest/gtest.h>

namespace edgesplat::sensor {
namespace {

TEST(ImageValues, EveryValueComesBack) {
  ImageRgb8 picture(16, 16);
  for (std::size_t i = 0; i < picture.values.size(); ++i) picture.values[i] = static_cast<std::uint8_t>(i);
  std::vector<float> floats(3, 7.0F);
  to_unit_floats(picture, floats);
  ASSERT_EQ(floats.size(), picture.values.size());
  EXPECT_EQ(floats[0], 0.0F);
  EXPECT_EQ(floats[255], 1.0F);
  EXPECT_EQ(to_rgb8(floats, 16, 16).values, picture.values);
}

TEST(ImageValues, CutsAndRounds) {
  const std::vector<float> colour = {-0.5F, 1.5F, 0.5F};
  const ImageRgb8 picture = to_rgb8(colour, 1, 1);
  EXPECT_EQ(picture.values, (std::vector<std::uint8_t>{0, 255, 128}));
}

}  // namespace
}  // namespace edgesplat::sensor
