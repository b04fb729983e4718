// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/span2d.hpp"
#include "common/base/strong_id.hpp"
#include "common/base/unique_fd.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <type_traits>
#include <unordered_set>
#include <vector>

namespace edgesplat {
namespace {

using AppleId = StrongId<struct AppleTag, std::uint32_t>;
using PearId = StrongId<struct PearTag, std::uint32_t>;
static_assert(!std::is_convertible_v<AppleId, PearId>);

bool is_open(int fd) {
  return ::fcntl(fd, F_GETFD) >= 0;
}

TEST(UniqueFd, ClosesWhatItOwnsExactlyOnce) {
  int raw = -1;
  {
    UniqueFd first(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    ASSERT_TRUE(first.valid());
    raw = first.get();
    UniqueFd second(std::move(first));
    EXPECT_FALSE(first.valid());  // NOLINT(bugprone-use-after-move): the moved-from state is the test
    EXPECT_TRUE(is_open(raw));
    second = UniqueFd(::open("/dev/zero", O_RDONLY | O_CLOEXEC));
    EXPECT_FALSE(is_open(raw));
    raw = second.get();
  }
  EXPECT_FALSE(is_open(raw));
}

TEST(Span2d, RowsFollowTheStride) {
  std::vector<int> values(12);
  for (int i = 0; i < 12; ++i) values[static_cast<std::size_t>(i)] = i;
  const Span2d<int> view(values.data(), 3, 3, 4);
  EXPECT_EQ(view(2, 1), 6);
  EXPECT_EQ(view.row(2).front(), 8);
  EXPECT_EQ(view.row(2).size(), 3U);
  view(0, 0) = 99;
  EXPECT_EQ(values[0], 99);
  EXPECT_TRUE(Span2d<int>().empty());
}

TEST(StrongId, ComparesAndHashes) {
  EXPECT_LT(AppleId{1}, AppleId{2});
  const std::unordered_set<AppleId> ids{AppleId{1}, AppleId{1}, AppleId{2}};
  EXPECT_EQ(ids.size(), 2U);
}

}  // namespace
}  // namespace edgesplat
