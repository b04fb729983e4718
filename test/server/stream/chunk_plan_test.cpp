// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/stream/chunk_plan.hpp"

#include <gtest/gtest.h>

#include <array>

namespace edgesplat::stream {
namespace {

constexpr std::array<map::ChunkId, 3> kChunks = {{{0, 0, 0}, {5, 0, 0}, {2, 0, 0}}};

TEST(ChunkPlan, SendsTheNearestFirstAndWaitsForConfirmations) {
  ChunkPlan plan(100);
  EXPECT_FALSE(plan.may_send());
  plan.restart(kChunks, {55.0F, 5.0F, 5.0F});
  EXPECT_TRUE(plan.withheld({0, 0, 0}));
  EXPECT_EQ(plan.take(), (map::ChunkId{5, 0, 0}));
  EXPECT_FALSE(plan.withheld({5, 0, 0}));
  plan.sent(10, 150);
  EXPECT_FALSE(plan.may_send());
  plan.confirmed(9);
  EXPECT_FALSE(plan.may_send());
  plan.confirmed(10);
  EXPECT_TRUE(plan.may_send());
  EXPECT_EQ(plan.take(), (map::ChunkId{2, 0, 0}));
  EXPECT_EQ(plan.take(), (map::ChunkId{0, 0, 0}));
  EXPECT_FALSE(plan.may_send());
}

TEST(ChunkPlan, AChunkGivenUpIsWithheldUntilItIsFetched) {
  ChunkPlan plan(100);
  EXPECT_FALSE(plan.fetch({1, 1, 1}));  // the robot has it
  EXPECT_TRUE(plan.release({1, 1, 1}));
  EXPECT_FALSE(plan.release({1, 1, 1}));
  EXPECT_TRUE(plan.withheld({1, 1, 1}));
  EXPECT_FALSE(plan.may_send());
  EXPECT_TRUE(plan.fetch({1, 1, 1}));
  EXPECT_FALSE(plan.fetch({1, 1, 1}));  // it waits already
  EXPECT_TRUE(plan.withheld({1, 1, 1}));
  EXPECT_EQ(plan.take(), (map::ChunkId{1, 1, 1}));
}

TEST(ChunkPlan, OneThatWaitsCanBeGivenUpToo) {
  ChunkPlan plan(100);
  plan.restart(kChunks, {0, 0, 0});
  EXPECT_TRUE(plan.release({5, 0, 0}));
  EXPECT_EQ(plan.waiting(), 2U);
  EXPECT_TRUE(plan.withheld({5, 0, 0}));
}

}  // namespace
}  // namespace edgesplat::stream
