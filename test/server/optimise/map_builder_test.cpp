// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/optimise/map_builder.hpp"

#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace edgesplat::optimise {
namespace {

TEST(MapBuilder, AddsRowsInRunsOfChunksAndKeepsTheSameMap) {
  mapping::IdAllocator ids(40000);
  MapBuilder builder(mapping::SeedOptions{}, ids);
  map::MapHash hash;
  std::size_t total = 0;
  std::set<std::uint64_t> seen;
  for (std::uint32_t id = 0; id < 5; ++id) {
    const MapChange change = builder.add(test::random_keyframe(id, 3000, id));
    ASSERT_TRUE(change.added.consistent());
    ASSERT_EQ(change.chunks.size(), change.added.size());
    EXPECT_TRUE(std::is_sorted(change.chunks.begin(), change.chunks.end()));
    for (std::size_t row = 0; row < change.added.size(); ++row) {
      const auto& m = change.added.means_m;
      EXPECT_EQ(change.chunks[row], map::chunk_of({m[3 * row], m[3 * row + 1], m[3 * row + 2]}));
      EXPECT_EQ(change.added.anchors[row].keyframe, id);
      EXPECT_EQ(change.added.anchors[row].pose_version, 2U);
      EXPECT_TRUE(seen.insert(change.added.ids[row].packed()).second);
      hash.add(change.chunks[row], map::record_digest(change.added, row));
    }
    total += change.added.size();
  }
  EXPECT_GT(total, 1000U);
  EXPECT_EQ(builder.gaussians().size(), total);
  EXPECT_EQ(builder.map_hash(), hash.value());
}

}  // namespace
}  // namespace edgesplat::optimise
