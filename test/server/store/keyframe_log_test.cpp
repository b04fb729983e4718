// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/store/keyframe_log.hpp"

#include "common/io/atomic_file.hpp"
#include "server/store/record.hpp"
#include "test/common/io/file_size_limit.hpp"
#include "test/support/random.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace edgesplat::store {
namespace {

std::vector<std::byte> keyframe(std::uint64_t seed, std::size_t size = 500) {
  test::Random random(seed);
  std::vector<std::byte> bytes(size);
  for (auto& b : bytes) b = static_cast<std::byte>(random.below(256));
  return bytes;
}

/// Without waiting for the disk: these files need not outlive a crash.
void write_plainly(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

KeyframeLog open(const std::filesystem::path& folder, const KeyframeLogConfig& config = {}) {
  auto log = KeyframeLog::open(folder, config);
  EXPECT_TRUE(log.has_value()) << log.error().context;
  return std::move(*log);
}

TEST(KeyframeLog, WhatWasAppendedIsThereAfterAnotherStart) {
  const test::TempDir folder;
  for (std::uint64_t start = 0; start < 3; ++start) {
    KeyframeLog log = open(folder.path() / "keyframes");
    ASSERT_EQ(log.size(), 10 * start);
    for (std::uint64_t i = 0; i < 10; ++i)
      ASSERT_TRUE(log.append(map::RobotId{2}, 77 + start, keyframe(10 * start + i)).has_value());
    for (std::uint64_t i = 0; i < log.size(); ++i) {
      const auto back = log.read(i);
      ASSERT_TRUE(back.has_value());
      EXPECT_EQ(back->bytes, keyframe(i));
      EXPECT_EQ(back->robot.value, 2);
      EXPECT_EQ(back->session, 77 + i / 10);
    }
    EXPECT_EQ(log.damaged_bytes(), 0U);
  }
}

// As if the power failed at any instant: what was half written is gone, all before it is there.
TEST(KeyframeLog, AnyTruncationLeavesTheWholeOnes) {
  const test::TempDir folder;
  const auto file = folder.path() / "keyframes-000001.log";
  {
    KeyframeLog log = open(folder.path());
    for (std::uint64_t i = 0; i < 3; ++i)
      ASSERT_TRUE(log.append(map::RobotId{2}, 1, keyframe(i, 60)).has_value());
  }
  const auto whole = *io::read_file(file, 1U << 20U);
  constexpr std::size_t kRecord_bytes = kRecordHeader_bytes + 10 + 60;
  ASSERT_EQ(whole.size(), 3 * kRecord_bytes);
  for (std::size_t n = 0; n <= whole.size(); ++n) {
    write_plainly(file, std::span(whole).first(n));
    KeyframeLog log = open(folder.path());
    ASSERT_EQ(log.size(), n / kRecord_bytes) << n;
    ASSERT_EQ(std::filesystem::file_size(file), n / kRecord_bytes * kRecord_bytes);
    if (n % 16 != 0) continue;
    ASSERT_TRUE(log.append(map::RobotId{2}, 1, keyframe(9, 60)).has_value());
    EXPECT_EQ(log.read(log.size() - 1)->bytes, keyframe(9, 60));
  }
}

TEST(KeyframeLog, AFlippedBitCostsOneKeyframe) {
  const test::TempDir folder;
  const auto file = folder.path() / "keyframes-000001.log";
  {
    KeyframeLog log = open(folder.path());
    for (std::uint64_t i = 0; i < 3; ++i)
      ASSERT_TRUE(log.append(map::RobotId{2}, 1, keyframe(i, 60)).has_value());
  }
  const auto whole = *io::read_file(file, 1U << 20U);
  for (std::size_t bit = 0; bit < 8 * whole.size(); bit += 7) {
    auto damaged = whole;
    damaged[bit / 8] ^= std::byte{1} << (bit % 8);
    write_plainly(file, damaged);
    const KeyframeLog log = open(folder.path());
    ASSERT_EQ(log.size(), 2U) << bit;
    EXPECT_GT(log.damaged_bytes(), 0U);
    for (std::size_t i = 0; i < log.size(); ++i) EXPECT_TRUE(log.read(i).has_value());
  }
}

TEST(KeyframeLog, TheOldestGoOverTheCap) {
  const test::TempDir folder;
  const KeyframeLogConfig config{20000, 3000};
  {
    KeyframeLog log = open(folder.path(), config);
    for (std::uint64_t i = 0; i < 200; ++i) {
      ASSERT_TRUE(log.append(map::RobotId{2}, 1, keyframe(i)).has_value());
      EXPECT_LE(log.bytes(), 20000U);
    }
    EXPECT_EQ(log.dropped() + log.size(), 200U);
    EXPECT_EQ(log.read(log.size() - 1)->bytes, keyframe(199));
    EXPECT_EQ(log.read(0)->bytes, keyframe(200 - log.size()));
  }
  std::uintmax_t disk_bytes = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder.path())) disk_bytes += file.file_size();
  EXPECT_LE(disk_bytes, 20000U);
  const KeyframeLog again = open(folder.path(), config);
  EXPECT_EQ(again.read(again.size() - 1)->bytes, keyframe(199));
}

TEST(KeyframeLog, SaysWhyItCannotBeOpenedOrRead) {
  const auto log = KeyframeLog::open("/dev/null/keyframes", {});
  ASSERT_FALSE(log.has_value());
  EXPECT_EQ(log.error().code, Errc::kIo);
  const test::TempDir folder;
  KeyframeLog good = open(folder.path());
  EXPECT_EQ(good.read(0).error().code, Errc::kNotFound);
  ASSERT_TRUE(good.append(map::RobotId{2}, 1, keyframe(1)).has_value());
  std::filesystem::resize_file(folder.path() / "keyframes-000001.log", 100);
  EXPECT_EQ(good.read(0).error().code, Errc::kIo);
}

TEST(KeyframeLog, AFullDiskLosesOneKeyframeAndTheLogGoesOn) {
  const test::TempDir folder;
  KeyframeLog log = open(folder.path());
  ASSERT_TRUE(log.append(map::RobotId{2}, 1, keyframe(1)).has_value());
  {
    const io::FileSizeLimit limit(700);
    const auto refused = log.append(map::RobotId{2}, 1, keyframe(2));
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, Errc::kIo);
  }
  EXPECT_EQ(log.size(), 1U);
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "keyframes-000001.log"), 527U);
  ASSERT_TRUE(log.append(map::RobotId{2}, 1, keyframe(3)).has_value());
  EXPECT_EQ(log.read(1)->bytes, keyframe(3));
  EXPECT_EQ(open(folder.path()).size(), 2U);
}

TEST(KeyframeLog, TheNewestAreReadWithoutOpeningIt) {
  const test::TempDir folder;
  EXPECT_TRUE(read_newest_keyframes(folder.path() / "none")->empty());
  KeyframeLogConfig config;
  config.segment_bytes = 1000;  // two keyframes
  auto log = open(folder.path(), config);
  for (std::uint64_t i = 0; i < 7; ++i) ASSERT_TRUE(log.append(map::RobotId{3}, 40 + i, keyframe(i)));
  const auto newest = read_newest_keyframes(folder.path());
  ASSERT_TRUE(newest.has_value()) << newest.error().context;
  ASSERT_EQ(newest->size(), 3U) << "one in the newest segment, two in the one before";
  for (std::uint64_t i = 0; i < 3; ++i) {
    EXPECT_EQ((*newest)[i].robot.value, 3);
    EXPECT_EQ((*newest)[i].session, 44 + i);
    EXPECT_EQ((*newest)[i].bytes, keyframe(4 + i));
  }
  ASSERT_TRUE(log.append(map::RobotId{3}, 99, keyframe(9))) << "the log goes on";

  // The end is cut off in the middle of the last one.
  const auto last = folder.path() / "keyframes-000004.log";
  std::filesystem::resize_file(last, std::filesystem::file_size(last) - 100);
  EXPECT_EQ(read_newest_keyframes(folder.path())->size(), 3U);
}

}  // namespace
}  // namespace edgesplat::store
