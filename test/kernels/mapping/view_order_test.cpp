// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/view_order.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace edgesplat::mapping {
namespace {

std::vector<std::size_t> turns(ViewOrder& order, std::size_t rounds, std::size_t count) {
  std::vector<std::size_t> times(count, 0);
  for (std::size_t i = 0; i < rounds; ++i) ++times[order.next()];
  return times;
}

TEST(ViewOrder, GivesEveryViewOnceARound) {
  ViewOrder order(7, {});
  for (int round = 0; round < 5; ++round) {
    std::set<std::size_t> seen;
    for (int i = 0; i < 7; ++i) seen.insert(order.next());
    EXPECT_EQ(seen.size(), 7U);
  }
}

TEST(ViewOrder, GivesExtraTurnsInProportionToLoss) {
  constexpr std::size_t kRounds = 2000;
  ViewOrder order(4, {.loss_share = 1.0F});
  order.tell(0, 3.0);
  order.tell(1, 1.0);
  order.tell(2, 0.0);
  order.tell(3, std::numeric_limits<double>::quiet_NaN());
  (void)turns(order, 0, 4);
  const auto times = turns(order, 8 * kRounds, 4);
  // Each round: one turn each and four by loss, three quarters of them for view 0.
  EXPECT_NEAR(static_cast<double>(times[0]), 4.0 * kRounds, 0.05 * 4.0 * kRounds);
  EXPECT_NEAR(static_cast<double>(times[1]), 2.0 * kRounds, 0.05 * 2.0 * kRounds);
  EXPECT_EQ(times[2], kRounds);
  EXPECT_EQ(times[3], kRounds);
}

TEST(ViewOrder, KnowsNothingAtFirstAndIsDeterministic) {
  ViewOrder one(5, {.loss_share = 0.5F, .seed = 9}), same(5, {.loss_share = 0.5F, .seed = 9});
  for (int i = 0; i < 50; ++i) {
    const std::size_t view = one.next();
    EXPECT_LT(view, 5U);
    EXPECT_EQ(view, same.next());
  }
  ViewOrder single(1, {.loss_share = 3.0F});
  EXPECT_EQ(single.next(), 0U);
}

}  // namespace
}  // namespace edgesplat::mapping
