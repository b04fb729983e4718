// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/even_sample.hpp"

#include <gtest/gtest.h>

namespace edgesplat::app {
namespace {

TEST(EvenSample, KeepsEverythingWhileItFits) {
  EvenSample<int> sample(8);
  for (int i = 0; i < 8; ++i) sample.add(i);
  EXPECT_EQ(sample.kept(), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(EvenSample, StaysBoundedAndEvenOverAnyLength) {
  for (int length = 1; length < 600; ++length) {
    EvenSample<int> sample(8);
    for (int i = 0; i < length; ++i) sample.add(i);
    const auto& kept = sample.kept();
    ASSERT_LE(kept.size(), 8U) << length;
    ASSERT_GE(kept.size(), static_cast<std::size_t>(std::min(length, 4))) << length;
    EXPECT_EQ(kept.front(), 0);
    for (std::size_t i = 2; i < kept.size(); ++i) {
      ASSERT_EQ(kept[i] - kept[i - 1], kept[1] - kept[0]) << length;
    }
    const int stride = kept.size() > 1 ? kept[1] - kept[0] : 1;
    EXPECT_LE(length - 1 - kept.back(), stride) << length;
  }
}

}  // namespace
}  // namespace edgesplat::app
