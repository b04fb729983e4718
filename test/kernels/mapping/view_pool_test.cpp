// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/view_pool.hpp"

#include <gtest/gtest.h>

#include <map>

namespace edgesplat::mapping {
namespace {

StoredView view(std::uint32_t id, int side_px = 16) {
  StoredView made;
  made.keyframe = map::KeyframeId{id};
  made.picture = sensor::ImageRgb8(side_px, side_px);
  return made;
}

std::map<std::uint32_t, int> turns(ViewPool& pool, int steps) {
  std::map<std::uint32_t, int> count;
  for (int i = 0; i < steps; ++i) ++count[pool.next()->keyframe.value];
  return count;
}

TEST(ViewPool, GivesNothingWhenEmpty) {
  ViewPool pool({});
  EXPECT_EQ(pool.next(), nullptr);
}

TEST(ViewPool, EveryViewHasItsTurnAndTheNewestMore) {
  ViewPoolOptions options;
  options.recent = 5;
  options.recent_share = 0.5F;
  ViewPool pool(options);
  for (std::uint32_t id = 0; id < 50; ++id) pool.add(view(id));
  const auto count = turns(pool, 10'000);
  ASSERT_EQ(count.size(), 50U);
  for (const auto& [id, times] : count) {
    // half of the steps over 50 views, the other half over the newest five
    const double expected = 100.0 + (id >= 45 ? 1000.0 : 0.0);
    EXPECT_NEAR(times, expected, 0.15 * expected) << id;
  }
}

TEST(ViewPool, TakesTurnsInRoundsWithoutTheNewestShare) {
  ViewPoolOptions options;
  options.recent_share = 0.0F;
  ViewPool pool(options);
  for (std::uint32_t id = 0; id < 30; ++id) pool.add(view(id));
  for (int round = 0; round < 3; ++round) {
    const auto count = turns(pool, 30);
    EXPECT_EQ(count.size(), 30U) << "each exactly once a round";
  }
}

TEST(ViewPool, StaysWithinItsBytesAndKeepsOldAndNew) {
  ViewPoolOptions options;
  options.max_bytes = 40 * view(0).size_bytes();
  ViewPool pool(options);
  for (std::uint32_t id = 0; id < 500; ++id) {
    pool.add(view(id));
    ASSERT_LE(pool.size_bytes(), options.max_bytes);
    ASSERT_EQ(pool.views().back().keyframe.value, id);
    ASSERT_EQ(pool.dropped() + pool.size(), id + 1U);
  }
  EXPECT_EQ(pool.views().front().keyframe.value, 0U);
  EXPECT_GE(pool.size(), 16U);
  const auto count = turns(pool, 2000);
  EXPECT_EQ(count.size(), pool.size());
}

TEST(ViewPool, OneViewLargerThanEverythingStillTrains) {
  ViewPoolOptions options;
  options.max_bytes = 100;
  ViewPool pool(options);
  pool.add(view(1));
  pool.add(view(2));
  EXPECT_EQ(pool.size(), 1U);
  EXPECT_EQ(pool.next()->keyframe.value, 2U);
}

}  // namespace
}  // namespace edgesplat::mapping
