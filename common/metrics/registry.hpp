// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/metrics/counter.hpp"
#include "common/metrics/histogram.hpp"

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace edgesplat::metrics {

/// The metrics of one program. An owned instance handed down by reference, never a global. Names carry their
/// unit: "uplink.queue_bytes", "tracking.group_ms". A name asked for twice is the same object; references
/// stay valid as long as the registry. Thread-safe; look names up once, not in a loop.
class Registry {
 public:
  Registry() = default;
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  [[nodiscard]] Counter& counter(std::string_view name) { return find_or_make(counters_, name); }
  [[nodiscard]] Gauge& gauge(std::string_view name) { return find_or_make(gauges_, name); }
  [[nodiscard]] Histogram& histogram(std::string_view name) { return find_or_make(histograms_, name); }

  /// {"counters": {name: n}, "gauges": {name: x}, "histograms": {name: {count, mean, min, p50, p95, p99,
  /// max}}, "process": {rss_bytes, peak_rss_bytes, cpu_s}}; names sorted, a value that is not finite is null.
  [[nodiscard]] std::string to_json() const;

 private:
  template <typename T>
  using ByName = std::map<std::string, std::unique_ptr<T>, std::less<>>;

  template <typename T>
  T& find_or_make(ByName<T>& metrics, std::string_view name) {
    const std::lock_guard lock(mutex_);
    auto found = metrics.find(name);
    if (found == metrics.end()) found = metrics.emplace(std::string(name), std::make_unique<T>()).first;
    return *found->second;
  }

  mutable std::mutex mutex_;
  ByName<Counter> counters_;
  ByName<Gauge> gauges_;
  ByName<Histogram> histograms_;
};

}  // namespace edgesplat::metrics
