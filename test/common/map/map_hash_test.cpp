// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/map_hash.hpp"

#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace edgesplat::map {
namespace {

MapHash hash_of(const QuantisedRows& all, const std::vector<std::size_t>& order) {
  MapHash hash;
  for (const std::size_t row : order) hash.add(all.chunks[row], record_digest(all, row));
  return hash;
}

std::vector<std::size_t> rows(std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  return order;
}

TEST(MapHash, DoesNotDependOnTheOrder) {
  const auto cloud = test::random_rows(300, 1);
  auto order = rows(300);
  const std::uint64_t straight = hash_of(cloud, order).value();
  std::mt19937 random(2);
  std::shuffle(order.begin(), order.end(), random);
  EXPECT_EQ(hash_of(cloud, order).value(), straight);
}

TEST(MapHash, EveryFieldCounts) {
  const auto cloud = test::random_rows(10, 1, 1);
  const std::uint64_t before = hash_of(cloud, rows(10)).value();
  const auto differs = [&](auto change) {
    auto other = cloud;
    change(other);
    return record_digest(other, 4) != record_digest(cloud, 4);
  };
  EXPECT_TRUE(differs([](auto& c) { c.ids[4] = gaussian::GaussianId(1, 99); }));
  for (std::size_t k = 0; k < kChannelCount; ++k)
    EXPECT_TRUE(differs([k](auto& c) { c.channels[4][k] ^= 1U; })) << k;
  EXPECT_TRUE(differs([](auto& c) { c.sh_rest[9 * 4 + 8] ^= 1; }));
  EXPECT_TRUE(differs([](auto& c) { c.anchors[4].keyframe += 1; }));
  EXPECT_TRUE(differs([](auto& c) { c.anchors[4].pose_version += 1; }));
  EXPECT_FALSE(differs([](auto& c) { c.channels[0][0] ^= 1U; }));  // another row's
  auto without_last = rows(9);
  EXPECT_NE(hash_of(cloud, without_last).value(), before);
}

TEST(MapHash, RemovingUndoesAdding) {
  const auto cloud = test::random_rows(20, 1);
  MapHash hash = hash_of(cloud, rows(19));
  const std::uint64_t before = hash.value();
  hash.add(cloud.chunks[19], record_digest(cloud, 19));
  EXPECT_NE(hash.value(), before);
  hash.remove(cloud.chunks[19], record_digest(cloud, 19));
  EXPECT_EQ(hash.value(), before);
}

TEST(MapHash, TheChunkCounts) {
  const auto cloud = test::random_rows(1, 1);
  MapHash here;
  MapHash there;
  here.add({0, 0, 0}, record_digest(cloud, 0));
  there.add({1, 0, 0}, record_digest(cloud, 0));
  EXPECT_NE(here.value(), there.value());
  EXPECT_EQ(here.chunk_value({0, 0, 0}), there.chunk_value({1, 0, 0}));
  EXPECT_EQ(here.chunk_value({5, 5, 5}), 0U);
}

}  // namespace
}  // namespace edgesplat::map
