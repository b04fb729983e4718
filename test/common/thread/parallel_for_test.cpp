// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/parallel_for.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <vector>

namespace edgesplat::thread {
namespace {

TEST(ParallelFor, RunsEveryIndexOnceAndReturnsWhenAllHaveRun) {
  std::vector<int> runs(10'000, 0);
  parallel_for(std::size_t{10}, runs.size(), [&](std::size_t i) { ++runs[i]; });
  for (std::size_t i = 0; i < runs.size(); ++i) EXPECT_EQ(runs[i], i < 10 ? 0 : 1) << i;
}

TEST(ParallelFor, AnEmptyRangeRunsNothing) {
  parallel_for(3, 3, [](int) { FAIL(); });
  parallel_for(3, 2, [](int) { FAIL(); });
}

// What ThreadSanitizer must take for ordered: it reports a race here where fork or join is not known to it.
TEST(ParallelFor, BodiesSeeWhatWasWrittenBeforeAndTheCallerWhatTheyWrote) {
  std::vector<std::vector<int>> rows;
  for (int round = 0; round < 50; ++round) {
    rows.assign(64, std::vector<int>(16, round));
    parallel_for(0, 64, [&](int row) {
      for (int& value : rows[static_cast<std::size_t>(row)]) value += row;
    });
    for (std::size_t row = 0; row < rows.size(); ++row)
      ASSERT_EQ(rows[row].back(), round + static_cast<int>(row));
  }
}

TEST(ParallelFor, RunsInsideAnother) {
  std::vector<std::vector<int>> table(16, std::vector<int>(64, 0));
  parallel_for(0, 16, [&](int row) {
    auto& cells = table[static_cast<std::size_t>(row)];
    parallel_for(std::size_t{0}, cells.size(), [&](std::size_t i) { cells[i] = row; });
  });
  for (std::size_t row = 0; row < table.size(); ++row)
    EXPECT_EQ(table[row], std::vector<int>(64, static_cast<int>(row)));
}

TEST(ParallelInvoke, RunsEachBodyOnce) {
  int a = 0;
  int b = 0;
  std::atomic<int> both = 0;
  parallel_invoke([&] { a += 1, ++both; }, [&] { b += 2, ++both; });
  EXPECT_EQ(a, 1);
  EXPECT_EQ(b, 2);
  EXPECT_EQ(both, 2);
}

}  // namespace
}  // namespace edgesplat::thread
