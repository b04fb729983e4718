// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/fault_injector.hpp"
#include "tools/virtual_device/pacer.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <chrono>

namespace edgesplat::virtual_device {
namespace {

int bits_set(std::span<const std::byte> bytes) {
  int count = 0;
  for (const std::byte b : bytes) count += std::popcount(std::to_integer<unsigned>(b));
  return count;
}

TEST(FaultInjector, WithoutFaultsEverythingPassesUntouched) {
  FaultInjector faults({}, 1);
  std::array<std::byte, 60> datagram{};
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(faults.pass(datagram));
  EXPECT_EQ(bits_set(datagram), 0);
  EXPECT_EQ(faults.flipped() + faults.dropped(), 0U);
}

TEST(FaultInjector, FlipsOneBitInTheShareAskedFor) {
  FaultInjector faults({.flip = 0.2, .drop = 0.1}, 7);
  int spoiled = 0, lost = 0;
  for (int i = 0; i < 10000; ++i) {
    std::array<std::byte, 60> datagram{};
    if (!faults.pass(datagram)) {
      ++lost;
      continue;
    }
    EXPECT_LE(bits_set(datagram), 1);
    spoiled += bits_set(datagram);
  }
  EXPECT_NEAR(lost, 1000, 100);
  EXPECT_NEAR(spoiled, 1800, 150);
  EXPECT_EQ(faults.flipped(), static_cast<std::uint64_t>(spoiled));
  EXPECT_EQ(faults.dropped(), static_cast<std::uint64_t>(lost));
}

TEST(FaultInjector, SameSeedSameFaults) {
  FaultInjector first({.flip = 0.5}, 3), second({.flip = 0.5}, 3);
  for (int i = 0; i < 100; ++i) {
    std::array<std::byte, 8> a{}, b{};
    first.pass(a);
    second.pass(b);
    EXPECT_EQ(a, b);
  }
}

double play_ms(Pacer& pacer, std::initializer_list<int> moments_ms) {
  const auto start = std::chrono::steady_clock::now();
  for (const int moment : moments_ms) {
    EXPECT_TRUE(pacer.wait_for(host_time_from_ns(1'700'000'000'000'000'000 + moment * 1'000'000LL), {}));
  }
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

TEST(Pacer, KeepsRecordedTimesWithoutAddingUpLateness) {
  Pacer pacer(1.0);
  const double took_ms = play_ms(pacer, {0, 10, 20, 30, 40, 50, 60});
  EXPECT_GE(took_ms, 60.0);
  EXPECT_LT(took_ms, 160.0);  // a loaded machine
}

TEST(Pacer, SpeedScalesTime) {
  Pacer pacer(10.0);
  const double took_ms = play_ms(pacer, {0, 200, 400});
  EXPECT_GE(took_ms, 40.0);
  EXPECT_LT(took_ms, 200.0);
}

TEST(Pacer, TimesThatGoBackDoNotWait) {
  Pacer pacer(1.0);
  EXPECT_LT(play_ms(pacer, {100, 0, 50, 100}), 50.0);
}

TEST(Pacer, StopEndsALongWait) {
  Pacer pacer(1.0);
  std::stop_source stop;
  EXPECT_TRUE(pacer.wait_for(host_time_from_ns(0), stop.get_token()));
  stop.request_stop();
  EXPECT_FALSE(pacer.wait_for(host_time_from_ns(3'600'000'000'000), stop.get_token()));
}

}  // namespace
}  // namespace edgesplat::virtual_device
