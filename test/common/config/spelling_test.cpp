// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/config/spelling.hpp"

#include "common/config/number_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace edgesplat::config {
namespace {

TEST(Spelling, FindsSlipsOfTheHandOnly) {
  const std::vector<std::string> keys{"voxel_size_m", "threads", "rate_hz"};
  EXPECT_EQ(nearest_spelling("voxle_size_m", keys), "voxel_size_m");
  EXPECT_EQ(nearest_spelling("voxel_size", keys), "voxel_size_m");
  EXPECT_EQ(nearest_spelling("rate", keys), "rate_hz");
  EXPECT_EQ(nearest_spelling("thread", keys), "threads");
  EXPECT_EQ(nearest_spelling("banana", keys), "");
  EXPECT_EQ(nearest_spelling("", keys), "");
  EXPECT_EQ(nearest_spelling(std::string(100000, 'a'), keys), "");
}

TEST(NumberText, IsTheShortestThatReadsBack) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(5.0), "5.0");
  EXPECT_EQ(number_text(-0.0), "-0.0");
  EXPECT_EQ(number_text(1e300), "1e+300");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(number_text(std::numeric_limits<double>::quiet_NaN()), "nan");
}

}  // namespace
}  // namespace edgesplat::config
