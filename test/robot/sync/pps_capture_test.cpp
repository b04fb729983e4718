// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/pps_capture.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace edgesplat::sync {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

TEST(PpsTrack, TellsPeriodAndJitter) {
  PpsTrack track;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const std::int64_t wobble_ns = i % 2 == 0 ? 500 : -500;
    EXPECT_TRUE(track.add({i, 1'700'000'000 * kSecond_ns + i * (kSecond_ns + 20'000) + wobble_ns}));
  }
  EXPECT_NEAR(track.period_error_ppm(), 20.0, 1.0);
  EXPECT_NEAR(track.jitter_us(), 1.0, 0.3);  // periods alternate by +- 1 us
  EXPECT_EQ(track.counters().lost, 0U);
}

TEST(PpsTrack, LostEdgesAreCounted) {
  PpsTrack track;
  for (std::uint32_t i = 0; i < 60; ++i)
    if (i % 10 != 3) {
      EXPECT_TRUE(track.add({i, i * kSecond_ns}));
    }
  EXPECT_EQ(track.counters().lost, 6U);
  EXPECT_EQ(track.counters().edges, 54U);
}

TEST(PpsTrack, AStrayEdgeIsNotUsedAndAStepOfTheClockIsBelieved) {
  PpsTrack track;
  for (std::uint32_t i = 0; i < 5; ++i) (void)track.add({i, i * kSecond_ns});
  EXPECT_FALSE(track.add({5, 4 * kSecond_ns + 300'000'000}));
  EXPECT_TRUE(track.add({6, 5 * kSecond_ns}));
  EXPECT_EQ(track.counters().strays, 1U);
  const std::int64_t step_ns = 3600 * kSecond_ns + 400'000'000;  // somebody set the wall clock
  int used = 0;
  for (std::uint32_t i = 7; i < 20; ++i) used += track.add({i, step_ns + i * kSecond_ns}) ? 1 : 0;
  EXPECT_EQ(track.counters().restarts, 1U);
  EXPECT_EQ(used, 10);
}

TEST(PpsTrack, AbsurdStampsAreBorne) {
  PpsTrack track;
  for (const std::int64_t stamp :
       {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max(), std::int64_t{0},
        std::int64_t{-1}, std::numeric_limits<std::int64_t>::min()})
    (void)track.add({0, stamp});
  EXPECT_EQ(track.counters().lost, 0U);
}

TEST(PpsEdge, OnFullSecondsTheNearestOneIsMeantWhileTheWallClockTellsWhich) {
  const auto of = [](std::int64_t wall_ns) { return utc_of_edge({1, wall_ns}, true); };
  constexpr std::int64_t kAt_ns = 1'700'000'000 * kSecond_ns;
  EXPECT_EQ(of(kAt_ns), kAt_ns);
  EXPECT_EQ(of(kAt_ns + 299'000'000), kAt_ns);
  EXPECT_EQ(of(kAt_ns - 299'000'000), kAt_ns);
  EXPECT_FALSE(of(kAt_ns + 301'000'000).has_value());
  EXPECT_FALSE(of(kAt_ns + 500'000'000).has_value());
  EXPECT_FALSE(of(kAt_ns - 301'000'000).has_value());
  for (const std::int64_t absurd :
       {std::numeric_limits<std::int64_t>::min(), std::int64_t{-1}, std::numeric_limits<std::int64_t>::max()})
    EXPECT_FALSE(of(absurd).has_value()) << absurd;
}

TEST(PpsEdge, PulsesThatBeginAnywhereAreWhatTheWallClockShows) {
  EXPECT_EQ(utc_of_edge({1, 1'700'000'000'370'000'123}, false), 1'700'000'000'370'000'123);
  EXPECT_FALSE(utc_of_edge({1, -5}, false).has_value());
}

TEST(PpsDevice, SaysWhatIsWrongWithAPath) {
  const auto absent = PpsDevice::open("/dev/no-such-pps");
  ASSERT_FALSE(absent.has_value());
  EXPECT_EQ(absent.error().code, Errc::kIo);
  const auto other = PpsDevice::open("/dev/null");
  ASSERT_FALSE(other.has_value());
  EXPECT_EQ(other.error().code, Errc::kInvalidConfig);
  EXPECT_NE(other.error().context.find("/dev/null"), std::string::npos);
}

}  // namespace
}  // namespace edgesplat::sync
