// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/uplink/spool.hpp"

#include "test/support/message_bytes.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

namespace edgesplat::uplink {
namespace {

using test::message_bytes;

std::size_t files_in(const std::filesystem::path& folder) {
  std::error_code error;
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder, error)) ++count;
  return count;
}

TEST(Spool, GivesBackTheNewestFirstFromMemoryAndDisk) {
  const test::TempDir folder;
  Spool spool({3000, 100000, folder.path() / "spool"});
  for (std::uint32_t i = 0; i < 10; ++i) spool.put(message_bytes(1000, i));
  EXPECT_EQ(files_in(folder.path() / "spool"), 7U);
  for (std::uint32_t i = 10; i-- > 0;) {
    EXPECT_EQ(spool.next_bytes(), 1000U);
    const auto bytes = spool.take();
    ASSERT_TRUE(bytes.has_value());
    EXPECT_EQ(*bytes, message_bytes(1000, i));
  }
  EXPECT_TRUE(spool.empty());
  EXPECT_FALSE(spool.take().has_value());
  EXPECT_EQ(files_in(folder.path() / "spool"), 0U);
  EXPECT_EQ(spool.counters().taken, 10U);
  EXPECT_EQ(spool.counters().dropped, 0U);
}

TEST(Spool, KeepsItsBoundsAndDropsTheOldest) {
  const test::TempDir folder;
  Spool spool({2500, 4500, folder.path() / "spool"});
  for (std::uint32_t i = 0; i < 100; ++i) {
    spool.put(message_bytes(1000, i));
    EXPECT_LE(spool.counters().memory_bytes, 2500U);
    EXPECT_LE(spool.counters().disk_bytes, 4500U);
    EXPECT_LE(files_in(folder.path() / "spool"), 4U);
  }
  EXPECT_EQ(spool.counters().items, 6U);
  EXPECT_EQ(spool.counters().dropped, 94U);
  for (std::uint32_t i = 100; i-- > 94;) EXPECT_EQ(*spool.take(), message_bytes(1000, i));
  EXPECT_TRUE(spool.empty());
}

TEST(Spool, WithoutADiskTheOldestIsDropped) {
  Spool spool({2500, 4500, {}});
  for (std::uint32_t i = 0; i < 5; ++i) spool.put(message_bytes(1000, i));
  EXPECT_EQ(spool.counters().dropped, 3U);
  EXPECT_EQ(*spool.take(), message_bytes(1000, 4));
  EXPECT_EQ(*spool.take(), message_bytes(1000, 3));
}

TEST(Spool, ADiskThatFailsIsCountedAndCostsOnlyWhatWentThere) {
  Spool spool({1500, 4500, "/proc/nowhere"});
  for (std::uint32_t i = 0; i < 3; ++i) spool.put(message_bytes(1000, i));
  EXPECT_EQ(spool.counters().disk_failures, 2U);
  EXPECT_EQ(*spool.take(), message_bytes(1000, 2));
}

TEST(Spool, LeavesNothingBehind) {
  const test::TempDir folder;
  {
    Spool spool({0, 10000, folder.path() / "spool"});
    spool.put(message_bytes(100));
    EXPECT_EQ(files_in(folder.path() / "spool"), 1U);
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "spool"));
}

}  // namespace
}  // namespace edgesplat::uplink
