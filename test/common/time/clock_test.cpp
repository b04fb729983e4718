// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/time/clock.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <type_traits>

namespace edgesplat {
namespace {

template <typename A, typename B>
concept Subtractable = requires(A a, B b) {
  a - b;
};
static_assert(Subtractable<HostTime, HostTime>);
static_assert(!Subtractable<HostTime, SensorTime>, "clock domains must not mix");
static_assert(!std::is_convertible_v<SensorTime, HostTime>);

TEST(Time, SecondsRoundToTheNearestNanosecond) {
  EXPECT_EQ(from_seconds(1.5).count(), 1'500'000'000);
  EXPECT_EQ(from_seconds(-1e-9).count(), -1);
  EXPECT_EQ(from_seconds(0.1).count(), 100'000'000);
  EXPECT_EQ(from_seconds(-0.1).count(), -100'000'000);
  EXPECT_DOUBLE_EQ(to_seconds(nanoseconds(250'000'000)), 0.25);
}

TEST(WallClock, IsTheSystems) {
  const auto before = std::chrono::system_clock::now();
  const std::int64_t now_ns = wall_clock_ns();
  const auto after = std::chrono::system_clock::now();
  EXPECT_GE(now_ns, nanoseconds(before.time_since_epoch()).count());
  EXPECT_LE(now_ns, nanoseconds(after.time_since_epoch()).count());
}

TEST(VirtualClock, StandsStillAndNeverGoesBack) {
  VirtualClock clock(host_time_from_ns(10));
  EXPECT_EQ(to_ns(clock.now()), 10);
  clock.advance_to(host_time_from_ns(30));
  clock.advance_to(host_time_from_ns(20));
  EXPECT_EQ(to_ns(clock.now()), 30);
}

TEST(VirtualClock, KeepsTheLatestOfSeveralThreads) {
  VirtualClock clock;
  const auto push = [&clock](std::int64_t first) {
    for (std::int64_t t = first; t <= 20000; t += 2) clock.advance_to(host_time_from_ns(t));
  };
  std::thread odd(push, 1);
  push(2);
  odd.join();
  EXPECT_EQ(to_ns(clock.now()), 20000);
}

TEST(SteadyClock, DoesNotGoBack) {
  const SteadyClock clock;
  const HostTime first = clock.now();
  EXPECT_GE(clock.now(), first);
}

}  // namespace
}  // namespace edgesplat
