// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/image/gray_rows.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace edgesplat::image {
namespace {

std::vector<std::uint8_t> noise(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random() % 3 == 0 ? 255 : random());
  return bytes;
}

int sum_of(const std::vector<std::uint8_t>& row, std::size_t first, std::size_t step) {
  return row[first] + row[first + step];
}

// Whole vectors, what is left beside them, and no pixel at all.
class GrayRows : public testing::TestWithParam<std::size_t> {};

TEST_P(GrayRows, AreTheWeighedMeansOfTheirPixelsAndWriteNothingElse) {
  const std::size_t count = GetParam();
  const auto above = noise(6 * count, 1), below = noise(6 * count, 2);
  std::vector<std::uint8_t> half_gray(count + 1, 7), half(count + 1, 7), gray(count + 1, 7);
  half_gray_row(above.data(), below.data(), half_gray.data(), count);
  half_row(above.data(), below.data(), half.data(), count);
  gray_row(above.data(), gray.data(), count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto channel = [&](std::size_t c) {
      return sum_of(above, 6 * i + c, 3) + sum_of(below, 6 * i + c, 3);
    };
    const double mean = (77.0 * channel(0) + 150.0 * channel(1) + 29.0 * channel(2)) / 1024.0;
    EXPECT_NEAR(half_gray[i], mean, 0.5) << i;
    EXPECT_NEAR(half[i], (sum_of(above, 2 * i, 1) + sum_of(below, 2 * i, 1)) / 4.0, 0.5) << i;
    const double brightness =
        (77.0 * above[3 * i] + 150.0 * above[3 * i + 1] + 29.0 * above[3 * i + 2]) / 256.0;
    EXPECT_NEAR(gray[i], brightness, 0.5) << i;
  }
  EXPECT_EQ(half_gray[count], 7);
  EXPECT_EQ(half[count], 7);
  EXPECT_EQ(gray[count], 7);
}

INSTANTIATE_TEST_SUITE_P(Sizes, GrayRows, testing::Values(0, 1, 15, 16, 33, 64, 127, 640));

}  // namespace
}  // namespace edgesplat::image
