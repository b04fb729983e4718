// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/line_vector.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>

namespace edgesplat {
namespace {

std::uintptr_t from_line(const void* memory) {
  return reinterpret_cast<std::uintptr_t>(memory) % 64;
}

TEST(LineVector, BeginsALineWhateverItsLength) {
  // malloc's megabytes begin 16 bytes into a page, its small blocks anywhere.
  for (const std::size_t count : {1U, 3U, 100U, 5000U, 1U << 20U, (1U << 22U) + 1U}) {
    const LineVector<float> floats(count);
    EXPECT_EQ(from_line(floats.data()), 0U) << count;
    const LineVector<std::uint8_t> bytes(count);
    EXPECT_EQ(from_line(bytes.data()), 0U) << count;
  }
}

TEST(LineVector, KeepsValuesAndLineAsItGrowsAndMoves) {
  LineVector<int> values;
  for (int i = 0; i < 100000; ++i) {
    values.push_back(i);
    ASSERT_EQ(from_line(values.data()), 0U) << i;
  }
  const int* const before = values.data();
  const LineVector<int> moved = std::move(values);
  EXPECT_EQ(moved.data(), before);
  const LineVector<int> copied = moved;
  EXPECT_EQ(from_line(copied.data()), 0U);
  EXPECT_EQ(copied, moved);
  EXPECT_EQ(copied[77777], 77777);
}

}  // namespace
}  // namespace edgesplat
