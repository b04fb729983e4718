// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/map_state.hpp"

#include "common/map/row_codec.hpp"
#include "test/common/map/delta_samples.hpp"
#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

#include <set>

namespace edgesplat::map {
namespace {

/// The hash a map of these rows must have, computed anew.
std::uint64_t hash_of(const QuantisedRows& rows) {
  MapHash hash;
  for (std::size_t row = 0; row < rows.size(); ++row) hash.add(rows.chunks[row], record_digest(rows, row));
  return hash.value();
}

MapState state_of(const QuantisedRows& rows) {
  MapState state;
  EXPECT_TRUE(state.apply({test::sample_header(), AddBody{rows}}).has_value());
  return state;
}

Status apply(MapState& state, auto body) {
  return state.apply({test::sample_header(), std::move(body)});
}

/// Every id is found at its row, and the hash kept step by step is that of the rows.
void expect_sound(const MapState& state) {
  for (std::uint32_t row = 0; row < state.size(); ++row) ASSERT_EQ(state.find(state.rows().ids[row]), row);
  EXPECT_TRUE(state.rows().consistent());
  EXPECT_EQ(state.hash(), hash_of(state.rows()));
}

TEST(MapState, AddsUpdatesAndRemoves) {
  const auto rows = test::random_rows(300, 1, 1);
  MapState state = state_of(rows);
  EXPECT_EQ(state.size(), 300U);
  EXPECT_EQ(state.hash(), hash_of(rows));
  auto after = rows;
  UpdateBody update;
  update.fields = static_cast<FieldMask>(Field::kColour) | static_cast<FieldMask>(Field::kSh);
  update.differences.sh_degree = 1;
  for (std::size_t row = 0; row < 300; row += 2) {
    after.channels[row][12] = static_cast<std::uint16_t>((after.channels[row][12] + 500) & 511);
    after.sh_rest[9 * row] = static_cast<std::int8_t>(after.sh_rest[9 * row] + 100);
    append_difference(after, row, rows, row, update.differences);
  }
  ASSERT_TRUE(apply(state, update).has_value());
  EXPECT_EQ(state.hash(), hash_of(after));
  expect_sound(state);
  RemoveBody remove;
  for (std::size_t row = 0; row < 300; row += 3) remove.ids.push_back(rows.ids[row]);
  remove.ids.push_back(gaussian::GaussianId(9, 9));  // unknown: passed over
  ASSERT_TRUE(apply(state, remove).has_value());
  EXPECT_EQ(state.size(), 200U);
  expect_sound(state);
}

TEST(MapState, AKnownIdTakesItsNewChunk) {
  const auto rows = test::random_rows(50, 1);
  MapState state = state_of(rows);
  QuantisedRows moved;
  moved.append_row(rows, 7);
  moved.chunks[0] = {77, 0, 0};
  ASSERT_TRUE(apply(state, AddBody{moved}).has_value());
  EXPECT_EQ(state.size(), 50U);
  EXPECT_EQ(state.rows().chunks[*state.find(rows.ids[7])], (ChunkId{77, 0, 0}));
  expect_sound(state);
}

TEST(MapState, AChunkIsReplacedOrDroppedAsAWhole) {
  const auto rows = test::random_rows(400, 1);
  MapState state = state_of(rows);
  const ChunkId chunk = rows.chunks[200];
  ChunkReplaceBody replace;
  replace.chunk = chunk;
  replace.level = 1;
  replace.rows.append_row(rows, 200);
  replace.rows.append_row(rows, 0);  // of another chunk: it moves here
  replace.rows.chunks.assign(2, chunk);
  ASSERT_TRUE(apply(state, replace).has_value());
  EXPECT_EQ(state.level(chunk), 1);
  std::size_t in_chunk = 0;
  for (const auto& c : state.rows().chunks) in_chunk += c == chunk ? 1U : 0U;
  EXPECT_EQ(in_chunk, 2U);
  expect_sound(state);
  ChunkReplaceBody drop;
  drop.chunk = chunk;
  drop.dropped = true;
  const std::size_t before = state.size();
  ASSERT_TRUE(apply(state, drop).has_value());
  EXPECT_EQ(state.size(), before - 2);
  EXPECT_EQ(state.chunks().chunk_value(chunk), 0U);
  EXPECT_EQ(state.level(chunk), 0);
  expect_sound(state);
}

TEST(MapState, ADeltaWithoutABaseBeginsAnEmptyMap) {
  MapState state = state_of(test::random_rows(50, 1));
  Delta delta{test::sample_header(), AddBody{test::random_rows(20, 2, 3)}};  // even of another SH degree
  delta.header.base_seq = 0;
  ASSERT_TRUE(state.apply(delta).has_value());
  EXPECT_EQ(state.size(), 20U);
  EXPECT_EQ(state.rows().sh_degree, 3);
  expect_sound(state);
}

TEST(MapState, RefusesAnotherShDegreeAndChangesNothing) {
  MapState state = state_of(test::random_rows(50, 1));
  const std::uint64_t before = state.hash();
  EXPECT_FALSE(apply(state, AddBody{test::random_rows(5, 2, 1)}).has_value());
  EXPECT_EQ(state.hash(), before);
  EXPECT_EQ(state.size(), 50U);
}

TEST(MapState, TheSameDeltasMakeTheSameHashOnBothSides) {
  MapState here;
  MapState there;
  for (const Delta& delta : test::all_kinds(100)) {
    ASSERT_TRUE(here.apply(delta).has_value());
    ASSERT_TRUE(there.apply(delta).has_value());
    EXPECT_EQ(here.hash(), there.hash());
    expect_sound(here);
  }
}

TEST(MapState, KeepsTheNewestMask) {
  MapState state;
  EXPECT_FALSE(state.newest_mask().has_value());
  ASSERT_TRUE(apply(state, MaskBody{1, 5, 2, 1, {9, 9}}).has_value());
  ASSERT_TRUE(apply(state, MaskBody{2, 4, 2, 1, {8, 8}}).has_value());
  EXPECT_EQ(state.newest_mask()->version, 5U);
}

TEST(MapState, ForgetsAChunkAlone) {
  const auto rows = test::random_rows(400, 1);
  MapState state = state_of(rows);
  const std::size_t gone = state.drop_chunk(rows.chunks[0]);
  EXPECT_GT(gone, 0U);
  EXPECT_EQ(state.size(), 400 - gone);
  EXPECT_EQ(state.drop_chunk(rows.chunks[0]), 0U);
  expect_sound(state);
}

}  // namespace
}  // namespace edgesplat::map
