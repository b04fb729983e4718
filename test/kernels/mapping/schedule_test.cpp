// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/schedule.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace edgesplat::mapping {
namespace {

TEST(Schedule, StartsSmallAndEndsLarge) {
  const Schedule schedule({.coarse_until = 0.25});
  EXPECT_EQ(schedule.shrink(0.0), 2);
  EXPECT_EQ(schedule.shrink(0.24), 2);
  EXPECT_EQ(schedule.shrink(0.25), 1);
  EXPECT_EQ(schedule.shrink(7.0), 1);
  EXPECT_EQ(Schedule({.coarse_until = 0.0}).shrink(0.0), 1);
}

TEST(Schedule, RaisesTheDegreeStepByStep) {
  const Schedule schedule({.sh_degree = 3, .sh_from = 0.3, .sh_every = 0.2});
  EXPECT_EQ(schedule.sh_degree(0.0), 0);
  EXPECT_EQ(schedule.sh_degree(0.31), 1);
  EXPECT_EQ(schedule.sh_degree(0.51), 2);
  EXPECT_EQ(schedule.sh_degree(0.71), 3);
  EXPECT_EQ(schedule.sh_degree(1.0), 3);
  EXPECT_EQ(Schedule({.sh_degree = 0, .sh_from = 0.0, .sh_every = 0.1}).sh_degree(1.0), 0);
  EXPECT_EQ(Schedule({.sh_degree = 3, .sh_from = 0.5}).sh_degree(0.5), 3) << "all at once";
}

TEST(Schedule, CoolsExponentially) {
  const Schedule schedule({.cool_from = 0.5, .cool_to = 0.01F});
  EXPECT_EQ(schedule.rate_share(0.0), 1.0F);
  EXPECT_EQ(schedule.rate_share(0.5), 1.0F);
  EXPECT_NEAR(schedule.rate_share(0.75), 0.1F, 1e-6F);
  EXPECT_NEAR(schedule.rate_share(1.0), 0.01F, 1e-6F);
  EXPECT_NEAR(schedule.rate_share(3.0), 0.01F, 1e-6F);
  EXPECT_EQ(Schedule({.cool_from = 1.0}).rate_share(1.0), 1.0F) << "never";
  const auto rates = scaled({.mean_m = 2.0F, .sh_rest = 8.0F}, 0.5F);
  EXPECT_EQ(rates.mean_m, 1.0F);
  EXPECT_EQ(rates.sh_rest, 4.0F);
}

TEST(Schedule, GrowsBetweenTwoMoments) {
  const Schedule schedule({.grow_from = 0.1, .grow_until = 0.6});
  EXPECT_FALSE(schedule.grows(0.05));
  EXPECT_TRUE(schedule.grows(0.1));
  EXPECT_FALSE(schedule.grows(0.6));
}

TEST(ScheduleOptions, RefuseWhatLiesOutside) {
  EXPECT_TRUE(ScheduleOptions{}.validate());
  EXPECT_FALSE(ScheduleOptions{.sh_degree = 4}.validate());
  EXPECT_FALSE(ScheduleOptions{.cool_to = 0.0F}.validate());
  const auto bad = ScheduleOptions{.coarse_until = std::numeric_limits<double>::quiet_NaN()}.validate();
  ASSERT_FALSE(bad);
  EXPECT_NE(bad.error().context.find("coarse_until"), std::string::npos);
}

}  // namespace
}  // namespace edgesplat::mapping
