// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/clock.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace edgesplat::metrics {

struct HistogramSummary {
  std::uint64_t count = 0;
  std::uint64_t not_finite = 0;  ///< NaN or infinite values, counted here and nowhere else
  double mean = 0.0;
  double min = 0.0;
  double p50 = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};

/// Distribution of a non-negative quantity (milliseconds, bytes, points) in buckets 2 % wide from 1e-6 to
/// 1e9: quantiles are right within 1 %, count, mean, min and max exactly. Values below 1e-6 (zero, negative)
/// share one bucket, reported as the smallest value seen. 14 KB each. record() is thread-safe and takes no
/// lock; a summary taken meanwhile may miss values that are just being recorded.
class Histogram {
 public:
  void record(double value);
  [[nodiscard]] HistogramSummary summary() const;

 private:
  static constexpr double kSmallest = 1e-6;
  static constexpr double kLogWidth = 0.019802627296179712;  // ln(1.02)
  static constexpr std::size_t kBuckets = 1746;              // 1e-6 * 1.02^1745 > 1e9; 0 is the underflow

  [[nodiscard]] static std::size_t bucket_of(double value);
  [[nodiscard]] static double middle_of(std::size_t bucket);

  std::array<std::atomic<std::uint64_t>, kBuckets> buckets_{};
  std::atomic<std::uint64_t> not_finite_{0};
  std::atomic<double> sum_{0.0};
  std::atomic<double> min_{std::numeric_limits<double>::infinity()};
  std::atomic<double> max_{-std::numeric_limits<double>::infinity()};
};

/// Records how long its scope took, in milliseconds.
class ScopedTimerMs {
 public:
  ScopedTimerMs(Histogram& histogram, const Clock& clock)
      : histogram_(histogram), clock_(clock), start_(clock.now()) {}
  ~ScopedTimerMs() { histogram_.record(to_seconds(clock_.now() - start_) * 1e3); }
  ScopedTimerMs(const ScopedTimerMs&) = delete;
  ScopedTimerMs& operator=(const ScopedTimerMs&) = delete;

 private:
  Histogram& histogram_;
  const Clock& clock_;
  HostTime start_;
};

}  // namespace edgesplat::metrics
