// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/stream/delta_ring.hpp"

#include <gtest/gtest.h>

namespace edgesplat::stream {
namespace {

TEST(DeltaRing, KeepsTheLastOnesWithinBothBounds) {
  DeltaRing ring(5, 1000);
  EXPECT_FALSE(ring.holds(1));
  for (std::uint64_t seq = 1; seq <= 20; ++seq) {
    ring.push(seq, std::vector<std::byte>(10, static_cast<std::byte>(seq)));
    EXPECT_LE(ring.size(), 5U);
  }
  EXPECT_FALSE(ring.holds(15));
  EXPECT_FALSE(ring.holds(21));
  for (std::uint64_t seq = 16; seq <= 20; ++seq) EXPECT_EQ(ring.at(seq)[0], static_cast<std::byte>(seq));
  ring.push(21, std::vector<std::byte>(980));
  EXPECT_EQ(ring.size(), 3U);
  EXPECT_LE(ring.bytes(), 1000U);
  EXPECT_FALSE(ring.holds(18));
  EXPECT_TRUE(ring.holds(19));
}

TEST(DeltaRing, OneThatIsTooLargeLeavesItEmptyAndItGoesOn) {
  DeltaRing ring(5, 100);
  ring.push(1, std::vector<std::byte>(10));
  ring.push(2, std::vector<std::byte>(200));
  EXPECT_EQ(ring.size(), 0U);
  EXPECT_EQ(ring.bytes(), 0U);
  ring.push(3, std::vector<std::byte>(10));
  EXPECT_TRUE(ring.holds(3));
  EXPECT_FALSE(ring.holds(2));
}

}  // namespace
}  // namespace edgesplat::stream
