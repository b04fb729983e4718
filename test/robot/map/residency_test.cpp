// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/map/residency.hpp"

#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace edgesplat::map {
namespace {

constexpr std::size_t kBytesEach = 100;

HostTime at_s(double seconds) {
  return HostTime(from_seconds(seconds));
}

DeltaHeader header() {
  DeltaHeader h;
  h.seq = 2;
  h.base_seq = 1;
  return h;
}

/// `count` Gaussians in each of the chunks x = 0 .. chunks - 1.
MapState row_of_chunks(int chunks, std::size_t count) {
  MapState state;
  auto rows = test::random_rows(static_cast<std::size_t>(chunks) * count, 1);
  for (std::size_t i = 0; i < rows.size(); ++i) rows.chunks[i] = {static_cast<std::int32_t>(i / count), 0, 0};
  EXPECT_TRUE(state.apply({header(), AddBody{rows}}).has_value());
  return state;
}

Delta dropped(const ChunkId& chunk) {
  ChunkReplaceBody body;
  body.chunk = chunk;
  body.dropped = true;
  return {header(), body};
}

void drop(MapState& state, Residency& residency, const ChunkId& chunk) {
  ASSERT_TRUE(state.apply(dropped(chunk)).has_value());
  residency.applied(dropped(chunk));
}

TEST(Residency, WithinTheBudgetNothingHappens) {
  const MapState state = row_of_chunks(8, 10);
  Residency residency(100 * kBytesEach);
  EXPECT_TRUE(residency.overflow(state, kBytesEach).empty());
  EXPECT_TRUE(residency.requests(state, kBytesEach, at_s(1)).empty());
  EXPECT_TRUE(residency.in_step());
}

TEST(Residency, NearTheBudgetTheFarthestAreGivenBackThroughTheServer) {
  const MapState state = row_of_chunks(10, 10);
  Residency residency(105 * kBytesEach);
  residency.robot_at({95.0F, 5.0F, 5.0F});
  EXPECT_TRUE(residency.overflow(state, kBytesEach).empty());
  const auto requests = residency.requests(state, kBytesEach, at_s(1));
  ASSERT_EQ(requests.size(), 1U);
  EXPECT_EQ(requests[0].kind, RequestKind::kRelease);
  EXPECT_EQ(requests[0].chunks, (std::vector<ChunkId>{{0, 0, 0}, {1, 0, 0}}));
  EXPECT_TRUE(residency.requests(state, kBytesEach, at_s(1.5)).empty());
  EXPECT_EQ(residency.requests(state, kBytesEach, at_s(2.1)).size(), 1U);
}

TEST(Residency, OverTheBudgetTheyGoAtOnceAndTheServerIsToldUntilItFollows) {
  MapState state = row_of_chunks(10, 10);
  Residency residency(80 * kBytesEach);
  residency.robot_at({95.0F, 5.0F, 5.0F});
  const auto chunks = residency.overflow(state, kBytesEach);
  ASSERT_EQ(chunks.size(), 3U);
  EXPECT_EQ(chunks[0], (ChunkId{0, 0, 0}));
  for (const auto& chunk : chunks) residency.dropped_alone(chunk, state.drop_chunk(chunk));
  EXPECT_FALSE(residency.in_step());
  EXPECT_TRUE(residency.overflow(state, kBytesEach).empty());
  for (double s = 1; s < 4; s += 1.1)
    EXPECT_EQ(residency.requests(state, kBytesEach, at_s(s)).at(0).chunks.size(), 3U);
  for (const auto& chunk : chunks) drop(state, residency, chunk);
  EXPECT_TRUE(residency.in_step());
  EXPECT_EQ(residency.absent_chunks(), 3U);
}

TEST(Residency, ChunksComeBackWhenTheRobotNearsThemAndRoomIsMade) {
  MapState state = row_of_chunks(10, 10);
  Residency residency(100 * kBytesEach);
  residency.robot_at({95.0F, 5.0F, 5.0F});
  (void)residency.requests(state, kBytesEach, at_s(1));
  for (const std::int32_t x : {0, 1}) drop(state, residency, {x, 0, 0});
  residency.robot_at({5.0F, 5.0F, 5.0F});
  // 80 of 100 are used, which leaves no room: the far end goes for them, one chunk at a time.
  const auto first = residency.requests(state, kBytesEach, at_s(2.1));
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].kind, RequestKind::kRelease);
  EXPECT_EQ(first[0].chunks, (std::vector<ChunkId>{{9, 0, 0}}));
  drop(state, residency, {9, 0, 0});
  const auto then = residency.requests(state, kBytesEach, at_s(2.2));
  ASSERT_EQ(then.size(), 1U);
  EXPECT_EQ(then[0].kind, RequestKind::kFetch);
  EXPECT_EQ(then[0].chunks, (std::vector<ChunkId>{{0, 0, 0}}));
}

TEST(Residency, AMapBegunAnewForgetsWhatWasAbsent) {
  MapState state = row_of_chunks(4, 10);
  Residency residency(100 * kBytesEach);
  drop(state, residency, {0, 0, 0});
  EXPECT_EQ(residency.absent_chunks(), 1U);
  Delta begins{header(), AddBody{}};
  begins.header.base_seq = 0;
  residency.applied(begins);
  EXPECT_EQ(residency.absent_chunks(), 0U);
}

}  // namespace
}  // namespace edgesplat::map
