// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/log/log.hpp"

#include "common/log/rate_limiter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace edgesplat::log {
namespace {

/// Restores the level that other tests expect.
class LogTest : public testing::Test {
 protected:
  void TearDown() override { set_level(Level::kInfo); }
};

std::string line_of(std::initializer_list<Field> fields) {
  return format_line("m", "e", std::span(fields.begin(), fields.size()));
}

TEST_F(LogTest, FormatsEveryKindOfValue) {
  EXPECT_EQ(line_of({{"a", -3}, {"b", std::uint64_t{18446744073709551615U}}, {"c", 0.25}, {"d", true}}),
            "m: e a=-3 b=18446744073709551615 c=0.25 d=true");
  EXPECT_EQ(line_of({{"s", std::string("plain")}, {"t", "two words"}}), "m: e s=plain t=\"two words\"");
  EXPECT_EQ(line_of({{"x", std::numeric_limits<double>::quiet_NaN()}, {"y", 1.0F / 3.0F}}),
            "m: e x=nan y=0.333333");
  EXPECT_EQ(line_of({}), "m: e");
}

TEST_F(LogTest, TextFromOutsideCannotForgeALine) {
  EXPECT_EQ(line_of({{"s", "a\nERROR b=\"1\"\x1b"}}), "m: e s=\"a\\nERROR b=\\\"1\\\"\\x1b\"");
  EXPECT_EQ(line_of({{"s", ""}}), "m: e s=\"\"");
}

TEST_F(LogTest, WritesOneLineToStderr) {
  testing::internal::CaptureStderr();
  EDGESPLAT_LOG_WARN("livox", "packet gap", "lost", 3, "from", "192.168.1.3");
  const std::string out = testing::internal::GetCapturedStderr();
  EXPECT_THAT(out, testing::EndsWith(" W livox: packet gap lost=3 from=192.168.1.3\n"));
  EXPECT_EQ(std::count(out.begin(), out.end(), '\n'), 1);
}

TEST_F(LogTest, ValuesBelowTheLevelAreNotEvaluated) {
  int evaluated = 0;
  const auto count = [&evaluated] { return ++evaluated; };
  testing::internal::CaptureStderr();
  EDGESPLAT_LOG_DEBUG("m", "quiet", "n", count());
  set_level(Level::kDebug);
  EDGESPLAT_LOG_DEBUG("m", "loud", "n", count());
  set_level(Level::kOff);
  EDGESPLAT_LOG_ERROR("m", "off", "n", count());
  const std::string out = testing::internal::GetCapturedStderr();
  EXPECT_EQ(evaluated, 1);
  EXPECT_THAT(out, testing::HasSubstr("loud n=1"));
  EXPECT_THAT(out, testing::Not(testing::HasSubstr("quiet")));
}

TEST_F(LogTest, ParsesLevels) {
  EXPECT_EQ(parse_level("trace").value(), Level::kTrace);
  EXPECT_EQ(parse_level("off").value(), Level::kOff);
  ASSERT_FALSE(parse_level("WARN"));
  EXPECT_EQ(parse_level("loud").error().code, Errc::kInvalidConfig);
}

TEST(RateLimiter, LetsOneThroughEachIntervalAndCountsTheRest) {
  RateLimiter limiter(std::chrono::seconds(1));
  const RateLimiter::Clock::time_point start{};
  EXPECT_TRUE(limiter.allow(start));
  EXPECT_FALSE(limiter.allow(start + std::chrono::milliseconds(10)));
  EXPECT_FALSE(limiter.allow(start + std::chrono::milliseconds(999)));
  EXPECT_TRUE(limiter.allow(start + std::chrono::seconds(1)));
  EXPECT_EQ(limiter.take_suppressed(), 2U);
  EXPECT_EQ(limiter.take_suppressed(), 0U);
}

}  // namespace
}  // namespace edgesplat::log
