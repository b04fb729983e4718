// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/time/clock.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

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

/// A wall clock 100 s ahead of the program's; after each reading the thread is held up for a while.
class HeldUpWallClock {
 public:
  explicit HeldUpWallClock(std::vector<std::int64_t> holds_ns) : holds_ns_(std::move(holds_ns)) {}
  static constexpr std::int64_t kAhead_ns = 100'000'000'000;
  std::int64_t operator()() {
    const std::int64_t shown_ns = to_ns(clock.now()) + kAhead_ns;
    if (readings < holds_ns_.size()) clock.advance_to(clock.now() + nanoseconds(holds_ns_[readings]));
    ++readings;
    return shown_ns;
  }
  VirtualClock clock{host_time_from_ns(1'000)};
  std::size_t readings = 0;

 private:
  std::vector<std::int64_t> holds_ns_;
};

std::int64_t apart_ns(const ClockPair& pair) {
  return pair.wall_ns - to_ns(pair.host) - HeldUpWallClock::kAhead_ns;
}

TEST(ReadClocks, OnceWhereNothingComesBetween) {
  HeldUpWallClock wall({});
  const ClockPair pair = read_clocks(wall.clock, std::ref(wall));
  EXPECT_EQ(wall.readings, 1U);
  EXPECT_EQ(apart_ns(pair), 0);
  EXPECT_EQ(pair.spread.count(), 0);
  EXPECT_EQ(to_ns(pair.host_at(pair.wall_ns - 300)), to_ns(pair.host) - 300);
}

TEST(ReadClocks, AgainWhereTheThreadWasHeldUp) {
  HeldUpWallClock wall({5'000'000, 7'000'000});
  EXPECT_EQ(apart_ns(read_clocks(wall.clock, std::ref(wall))), 0);
  EXPECT_EQ(wall.readings, 3U);
}

TEST(ReadClocks, TheNearestWhereItAlwaysIs) {
  HeldUpWallClock wall({5'000'000, 3'000'000, 1'000'000, 4'000'000, 2'000'000, 0});
  const ClockPair pair = read_clocks(wall.clock, std::ref(wall));
  EXPECT_EQ(wall.readings, 5U) << "it does not try forever";
  EXPECT_EQ(pair.spread.count(), 1'000'000);
  EXPECT_EQ(apart_ns(pair), -500'000);
}

TEST(ReadClocks, TakesTheSystemsWallClock) {
  const SteadyClock clock;
  const std::int64_t before_ns = wall_clock_ns();
  const ClockPair pair = read_clocks(clock);
  EXPECT_GE(pair.wall_ns, before_ns);
  EXPECT_LE(pair.host, clock.now());
}

}  // namespace
}  // namespace edgesplat
