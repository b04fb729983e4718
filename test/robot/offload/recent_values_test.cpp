// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/offload/recent_values.hpp"

#include <gtest/gtest.h>

namespace edgesplat::offload {
namespace {

HostTime at(double seconds) {
  return HostTime(from_seconds(seconds));
}

TEST(RecentValues, NothingWhereThereIsNothing) {
  RecentValues values(std::chrono::seconds(2));
  EXPECT_FALSE(values.p95(at(1)).has_value());
  EXPECT_FALSE(values.largest(at(1)).has_value());
}

TEST(RecentValues, NearestRank) {
  RecentValues values(std::chrono::seconds(2));
  for (int i = 100; i >= 1; --i) values.add(i, at(1));
  EXPECT_EQ(values.p95(at(1)), 95.0);
  EXPECT_EQ(values.largest(at(1)), 100.0);
}

TEST(RecentValues, OldOnesAreForgotten) {
  RecentValues values(std::chrono::seconds(2));
  values.add(50, at(1));
  values.add(10, at(2));
  EXPECT_EQ(values.largest(at(3)), 50.0);
  EXPECT_EQ(values.largest(at(3.1)), 10.0);
  EXPECT_FALSE(values.largest(at(4.1)).has_value());
}

TEST(RecentValues, HoldsABoundedNumber) {
  RecentValues values(std::chrono::seconds(2));
  for (int i = 0; i < 100000; ++i) values.add(100000 - i, at(1));
  EXPECT_EQ(values.largest(at(1)), 1024.0);
}

}  // namespace
}  // namespace edgesplat::offload
