// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/simd_level.hpp"

#include "test/support/simd_limit.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace edgesplat::core {
namespace {

TEST(SimdLevel, TheBestIsUsedUnlessLimited) {
  const auto levels = available_simd_levels();
  ASSERT_FALSE(levels.empty());
  EXPECT_TRUE(std::ranges::is_sorted(levels));
  EXPECT_EQ(simd_level(), levels.back());
  for (const SimdLevel level : levels) {
    const test::SimdLimit limit(level);
    EXPECT_EQ(simd_level(), level);
    EXPECT_EQ(available_simd_levels(), levels) << "the processor stays what it is";
  }
  EXPECT_EQ(simd_level(), levels.back());
}

}  // namespace
}  // namespace edgesplat::core
