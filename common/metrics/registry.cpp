// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/registry.hpp"

#include "common/metrics/process_usage.hpp"

#include <nlohmann/json.hpp>

namespace edgesplat::metrics {
namespace {

nlohmann::json to_object(const HistogramSummary& s) {
  return {{"count", s.count}, {"not_finite", s.not_finite},
          {"mean", s.mean},   {"min", s.min},
          {"p50", s.p50},     {"p95", s.p95},
          {"p99", s.p99},     {"max", s.max}};
}

}  // namespace

std::string Registry::to_json() const {
  nlohmann::json out;
  {
    const std::lock_guard lock(mutex_);
    out["counters"] = nlohmann::json::object();
    for (const auto& [name, counter] : counters_) out["counters"][name] = counter->value();
    out["gauges"] = nlohmann::json::object();
    for (const auto& [name, gauge] : gauges_) out["gauges"][name] = gauge->value();
    out["histograms"] = nlohmann::json::object();
    for (const auto& [name, histogram] : histograms_)
      out["histograms"][name] = to_object(histogram->summary());
  }
  const ProcessUsage usage = process_usage();
  out["process"] = {
      {"rss_bytes", usage.rss_bytes}, {"peak_rss_bytes", usage.peak_rss_bytes}, {"cpu_s", usage.cpu_s}};
  // Names may come from outside (a topic, a device): bytes that are not UTF-8 are replaced, never thrown at.
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace edgesplat::metrics
