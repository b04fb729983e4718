// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/store/record.hpp"

#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace edgesplat::store {
namespace {

std::vector<std::byte> file_of(const std::vector<std::size_t>& sizes) {
  std::vector<std::byte> file;
  test::Random random(1);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    std::vector<std::byte> payload(sizes[i]);
    for (auto& b : payload) b = static_cast<std::byte>(random.below(256));
    const auto header = record_header(static_cast<std::uint8_t>(i), payload);
    file.insert(file.end(), header.begin(), header.end());
    file.insert(file.end(), payload.begin(), payload.end());
  }
  return file;
}

std::vector<int> types_in(std::span<const std::byte> file) {
  RecordReader reader(file, 0);
  std::vector<int> types;
  while (const auto record = reader.next()) types.push_back(record->type);
  return types;
}

TEST(Record, ReadsBackWhatWasWritten) {
  const auto file = file_of({5, 0, 1000});
  RecordReader reader(file, 0);
  EXPECT_EQ(reader.next()->payload.size(), 5U);
  EXPECT_EQ(reader.next()->payload.size(), 0U);
  EXPECT_EQ(reader.next()->payload.size(), 1000U);
  EXPECT_FALSE(reader.next().has_value());
  EXPECT_EQ(reader.damaged_bytes(), 0U);
}

TEST(Record, AFlippedBitCostsItsOwnRecordOnly) {
  auto file = file_of({40, 50, 60});
  const std::size_t ends[] = {17 + 40, 17 + 40 + 17 + 50, file.size()};
  for (std::size_t bit = 0; bit < 8 * file.size(); ++bit) {
    file[bit / 8] ^= std::byte{1} << (bit % 8);
    std::vector<int> expected;
    for (int i = 0; i < 3; ++i) {
      const std::size_t begin = i == 0 ? 0 : ends[i - 1];
      if (bit / 8 < begin || bit / 8 >= ends[i]) expected.push_back(i);
    }
    ASSERT_EQ(types_in(file), expected) << bit;
    file[bit / 8] ^= std::byte{1} << (bit % 8);
  }
}

TEST(Record, ATruncatedFileGivesItsWholeRecords) {
  const auto file = file_of({40, 50, 60});
  for (std::size_t n = 0; n <= file.size(); ++n) {
    const std::size_t whole = n >= file.size() ? 3U : n >= 124 ? 2U : n >= 57 ? 1U : 0U;
    ASSERT_EQ(types_in(std::span(file).first(n)).size(), whole) << n;
  }
}

TEST(Record, GarbageInBetweenIsPassedOver) {
  auto file = file_of({40, 50});
  file.insert(file.begin() + 57, 333, std::byte{'E'});
  RecordReader reader(file, 0);
  EXPECT_TRUE(reader.next() && reader.next());
  EXPECT_EQ(reader.damaged_bytes(), 333U);
}

}  // namespace
}  // namespace edgesplat::store
