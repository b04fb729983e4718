// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/prober.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace edgesplat::link {
namespace {

HostTime at(double seconds) {
  return HostTime(from_seconds(seconds));
}

/// Times at which packets go out, asked every millisecond.
std::vector<double> packets(Prober& prober, const Prober::Situation& situation, double from_s, double to_s) {
  std::vector<double> times;
  for (double t = from_s; t < to_s; t += 0.001) {
    while (prober.due(situation, at(t))) times.push_back(t);
  }
  return times;
}

TEST(Prober, FirstTrainIsSixteenPacketsAtTwiceTheAssumedRate) {
  Prober prober;
  Prober::Situation s;
  s.allowed = s.idle = true;
  const auto times = packets(prober, s, 10, 11);
  ASSERT_EQ(times.size(), 16U);
  EXPECT_NEAR(times.back() - times.front(), 15 * 1200 / 750e3, 0.002);
}

TEST(Prober, IsSilentWhereNobodyNeedsItOrTrafficMeasures) {
  Prober prober;
  Prober::Situation s;
  s.idle = true;
  EXPECT_TRUE(packets(prober, s, 10, 30).empty());
  s.allowed = true;
  s.idle = false;
  EXPECT_TRUE(packets(prober, s, 30, 50).empty());
  s.idle = true;
  s.bytes_per_s = 1e6;
  s.confirmed_at = at(49);
  EXPECT_TRUE(packets(prober, s, 50, 53.9).empty());
  EXPECT_FALSE(packets(prober, s, 53.9, 54.1).empty());
}

TEST(Prober, UsesAtMostTwoPercentOfTheLinkEveryFiveSeconds) {
  for (const double rate : {25e3, 100e3, 1e6, 10e6}) {
    Prober prober;
    Prober::Situation s;
    s.allowed = s.idle = true;
    s.bytes_per_s = rate;
    s.confirmed_at = at(0);
    const auto times = packets(prober, s, 10, 210);
    EXPECT_LE(1200.0 * static_cast<double>(times.size()) / 200.0, 0.0215 * rate) << rate;
    EXPECT_GE(times.size(), 4U * 15U) << rate;
    double train = times.front();
    for (const double t : times) {
      if (t - train > 0.5) {
        EXPECT_GE(t - train, 4.99) << rate;
        train = t;
      }
    }
  }
}

}  // namespace
}  // namespace edgesplat::link
