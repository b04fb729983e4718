// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/optimise/map_builder.hpp"

#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>

namespace edgesplat::optimise {
namespace {

TEST(MapBuilder, AppendsSeededGaussiansAndNamesTheirRows) {
  mapping::IdAllocator ids(40000);
  MapBuilder builder(mapping::SeedOptions{}, ids);
  std::uint32_t total = 0;
  std::set<std::uint64_t> seen;
  for (std::uint32_t id = 0; id < 5; ++id) {
    const MapChange change = builder.add(test::random_keyframe(id, 3000, id));
    const auto& cloud = builder.gaussians();
    ASSERT_TRUE(cloud.consistent());
    for (const std::uint32_t row : change.changed_rows) {
      EXPECT_EQ(row, total++);
      ASSERT_LT(row, cloud.size());
      EXPECT_EQ(cloud.anchors[row].keyframe, id);
      EXPECT_EQ(cloud.anchors[row].pose_version, 2U);
      EXPECT_TRUE(seen.insert(cloud.ids[row].packed()).second);
    }
  }
  EXPECT_GT(total, 1000U);
  EXPECT_EQ(builder.gaussians().size(), total);
}

}  // namespace
}  // namespace edgesplat::optimise
