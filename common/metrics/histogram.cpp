// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/histogram.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::metrics {

std::size_t Histogram::bucket_of(double value) {
  if (value < kSmallest) return 0;
  const double index = 1.0 + std::floor(std::log(value / kSmallest) / kLogWidth);
  return static_cast<std::size_t>(std::min(index, static_cast<double>(kBuckets - 1)));
}

double Histogram::middle_of(std::size_t bucket) {
  return kSmallest * std::exp((static_cast<double>(bucket) - 0.5) * kLogWidth);
}

void Histogram::record(double value) {
  if (!std::isfinite(value)) {
    not_finite_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  double seen = min_.load(std::memory_order_relaxed);
  while (value < seen && !min_.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
  }
  seen = max_.load(std::memory_order_relaxed);
  while (value > seen && !max_.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
  }
  sum_.fetch_add(value, std::memory_order_relaxed);
  // Last and released: a summary that counts this value also sees its minimum, maximum and sum.
  buckets_[bucket_of(value)].fetch_add(1, std::memory_order_release);
}

HistogramSummary Histogram::summary() const {
  HistogramSummary out;
  std::array<std::uint64_t, kBuckets> counts{};
  for (std::size_t i = 0; i < kBuckets; ++i) {
    counts[i] = buckets_[i].load(std::memory_order_acquire);
    out.count += counts[i];
  }
  out.not_finite = not_finite_.load(std::memory_order_relaxed);
  if (out.count == 0) return out;
  out.min = min_.load(std::memory_order_relaxed);
  out.max = max_.load(std::memory_order_relaxed);
  out.mean = sum_.load(std::memory_order_relaxed) / static_cast<double>(out.count);
  const auto quantile = [&](double q) {
    // Nearest rank: the smallest value with at least q of all values at or below it.
    const auto rank = static_cast<std::uint64_t>(std::ceil(q * static_cast<double>(out.count)));
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < kBuckets; ++i) {
      below += counts[i];
      if (below >= rank) return i == 0 ? out.min : std::clamp(middle_of(i), out.min, out.max);
    }
    return out.max;
  };
  out.p50 = quantile(0.50);
  out.p95 = quantile(0.95);
  out.p99 = quantile(0.99);
  return out;
}

}  // namespace edgesplat::metrics
