// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/result.hpp"

#include "common/base/check.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <set>

namespace edgesplat {
namespace {

Result<int> half(int value) {
  if (value % 2 != 0) return fail(Errc::kInvalidArgument, "odd");
  return value / 2;
}
Result<int> quarter(int value) {
  EDGESPLAT_TRY(const int once, half(value));
  EDGESPLAT_TRY(const int twice, half(once));
  return twice;
}
Status require_even(int value) {
  EDGESPLAT_TRY_STATUS(half(value));
  return {};
}
Result<std::unique_ptr<int>> owned(int value) {
  EDGESPLAT_TRY(auto inner, Result<std::unique_ptr<int>>(std::make_unique<int>(value)));
  return inner;
}

TEST(Result, TryUnwrapsOrReturnsTheError) {
  EXPECT_EQ(quarter(12).value(), 3);
  const auto failed = quarter(6);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().code, Errc::kInvalidArgument);
  EXPECT_EQ(failed.error().context, "odd");
  EXPECT_STREQ(failed.error().where.function_name() == nullptr ? "" : "set", "set");
  EXPECT_TRUE(require_even(2));
  EXPECT_FALSE(require_even(3));
}

TEST(Result, TryMovesWhatCannotBeCopied) {
  EXPECT_EQ(**owned(5), 5);
}

TEST(Result, FailRemembersWhereItArose) {
  const Status failed = fail(Errc::kIo, "disk full");
  EXPECT_NE(std::string(failed.error().where.file_name()).find("result_test.cpp"), std::string::npos);
}

TEST(Errc, NamesAreDistinct) {
  std::set<std::string_view> names;
  for (int code = 0; code <= static_cast<int>(Errc::kCorrupt); ++code) {
    names.insert(to_string(static_cast<Errc>(code)));
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(Errc::kCorrupt) + 1);
  EXPECT_FALSE(names.contains("unknown"));
}

TEST(ExitCode, TwoForConfigurationElseOne) {
  EXPECT_EQ(exit_code(Error{Errc::kInvalidConfig, ""}), 2);
  EXPECT_EQ(exit_code(Error{Errc::kIo, ""}), 1);
}

TEST(CheckDeathTest, AbortsWithThePlaceAndTheReason) {
  EDGESPLAT_CHECK(1 + 1 == 2, "arithmetic holds");
  EXPECT_DEATH(EDGESPLAT_CHECK(1 + 1 == 3, "arithmetic holds"),
               "result_test.cpp.*1 \\+ 1 == 3 \\(arithmetic holds\\)");
}

}  // namespace
}  // namespace edgesplat
