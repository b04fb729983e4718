// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/histogram.hpp"

#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

namespace edgesplat::metrics {
namespace {

double exact_quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

TEST(Histogram, EmptyIsAllZeros) {
  const HistogramSummary summary = Histogram().summary();
  EXPECT_EQ(summary.count, 0U);
  EXPECT_EQ(summary.p99, 0.0);
  EXPECT_EQ(summary.max, 0.0);
}

TEST(Histogram, OneValueIsExact) {
  Histogram histogram;
  histogram.record(12.34);
  const HistogramSummary summary = histogram.summary();
  EXPECT_EQ(summary.min, 12.34);
  EXPECT_EQ(summary.p50, 12.34);
  EXPECT_EQ(summary.p99, 12.34);
  EXPECT_EQ(summary.mean, 12.34);
}

TEST(Histogram, QuantilesAreWithinTwoPercentOfTheSortedValues) {
  test::Random random(1);
  for (const double scale : {1e-4, 1.0, 3e5}) {
    Histogram histogram;
    std::vector<double> values;
    for (int i = 0; i < 20000; ++i) {
      values.push_back(scale * std::exp(1.5 * random.normal()));
      histogram.record(values.back());
    }
    const HistogramSummary summary = histogram.summary();
    EXPECT_NEAR(summary.p50 / exact_quantile(values, 0.50), 1.0, 0.02);
    EXPECT_NEAR(summary.p95 / exact_quantile(values, 0.95), 1.0, 0.02);
    EXPECT_NEAR(summary.p99 / exact_quantile(values, 0.99), 1.0, 0.02);
    EXPECT_EQ(summary.max, *std::max_element(values.begin(), values.end()));
    EXPECT_EQ(summary.min, *std::min_element(values.begin(), values.end()));
  }
}

TEST(Histogram, TakesZeroNegativeAndHugeValuesAndCountsWhatIsNotFinite) {
  Histogram histogram;
  for (const double value : {0.0, -3.0, 1e30, 1.0}) histogram.record(value);
  histogram.record(std::nan(""));
  histogram.record(std::numeric_limits<double>::infinity());
  const HistogramSummary summary = histogram.summary();
  EXPECT_EQ(summary.count, 4U);
  EXPECT_EQ(summary.not_finite, 2U);
  EXPECT_EQ(summary.min, -3.0);
  EXPECT_EQ(summary.max, 1e30);
  EXPECT_EQ(summary.p50, -3.0) << "the underflow bucket is reported as the smallest value";
}

TEST(Histogram, CountsEveryValueOfSeveralThreads) {
  Histogram histogram;
  const auto work = [&histogram] {
    for (int i = 1; i <= 10000; ++i) histogram.record(i);
  };
  std::thread other(work);
  work();
  for (int i = 0; i < 10; ++i) (void)histogram.summary();
  other.join();
  const HistogramSummary summary = histogram.summary();
  EXPECT_EQ(summary.count, 20000U);
  EXPECT_DOUBLE_EQ(summary.mean, 5000.5);
  EXPECT_NEAR(summary.p50, 5000.0, 100.0);
}

TEST(ScopedTimerMs, RecordsTheScope) {
  VirtualClock clock;
  Histogram histogram;
  {
    const ScopedTimerMs timer(histogram, clock);
    clock.advance_to(HostTime(std::chrono::microseconds(2500)));
  }
  EXPECT_DOUBLE_EQ(histogram.summary().max, 2.5);
}

}  // namespace
}  // namespace edgesplat::metrics
