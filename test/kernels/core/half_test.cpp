// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/half.hpp"

#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace edgesplat::core {
namespace {

TEST(Half, PublishedValues) {
  EXPECT_EQ(half_of_float(1.0F), 0x3C00);
  EXPECT_EQ(half_of_float(-2.0F), 0xC000);
  EXPECT_EQ(half_of_float(65504.0F), 0x7BFF);
  EXPECT_EQ(half_of_float(0x1p-14F), 0x0400);
  EXPECT_EQ(half_of_float(0x1p-24F), 0x0001);
  EXPECT_EQ(half_of_float(0x1p-26F), 0x0000);
  EXPECT_EQ(half_of_float(-0.0F), 0x8000);
  EXPECT_EQ(half_of_float(0.333251953125F), 0x3555);
  EXPECT_EQ(half_of_float(1.0F + 0x1p-11F), 0x3C00) << "a tie goes to the even one";
  EXPECT_EQ(half_of_float(1.0F + 3 * 0x1p-11F), 0x3C02);
  EXPECT_EQ(half_of_float(1e30F), 0x7BFF) << "finite stays finite";
  EXPECT_EQ(half_of_float(std::numeric_limits<float>::infinity()), 0x7C00);
  EXPECT_TRUE(std::isnan(float_of_half(half_of_float(std::nanf("")))));
}

TEST(Half, EveryHalfComesBack) {
  for (std::uint32_t bits = 0; bits < 0x10000U; ++bits) {
    if ((bits & 0x7C00U) == 0x7C00U && (bits & 0x3FFU) != 0) continue;  // NaN
    ASSERT_EQ(half_of_float(float_of_half(static_cast<std::uint16_t>(bits))), bits);
  }
}

TEST(Half, IsTheNearest) {
  test::Random random(1);
  for (int i = 0; i < 100000; ++i) {
    const auto value = static_cast<float>(random.normal() * std::exp2(random.uniform(-26.0, 15.0)));
    if (std::abs(value) > 65504.0F) continue;
    const std::uint16_t bits = half_of_float(value);
    const float apart = std::abs(float_of_half(bits) - value);
    for (const int step : {-1, 1}) {
      const auto other = static_cast<std::uint16_t>(bits + step);
      if ((other & 0x7C00U) == 0x7C00U) continue;
      ASSERT_LE(apart, std::abs(float_of_half(other) - value)) << value;
    }
  }
}

}  // namespace
}  // namespace edgesplat::core
