// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/run_metrics.hpp"

namespace edgesplat::report {

std::optional<double> number_of(const nlohmann::json& json, const char* key) {
  if (!json.is_object() || !json.contains(key) || !json[key].is_number()) return std::nullopt;
  return json[key].get<double>();
}

std::optional<double> find_metric(const nlohmann::json& metrics, const std::vector<std::string>& names) {
  if (!metrics.is_object()) return std::nullopt;
  for (const std::string& name : names) {
    for (const char* kind : {"counters", "gauges"}) {
      if (!metrics.contains(kind) || !metrics[kind].contains(name)) continue;
      if (metrics[kind][name].is_number()) return metrics[kind][name].get<double>();
    }
  }
  return std::nullopt;
}

std::optional<double> find_histogram(const nlohmann::json& metrics, const std::string& name,
                                     const char* percentile) {
  if (!metrics.is_object() || !metrics.contains("histograms") || !metrics["histograms"].contains(name)) {
    return std::nullopt;
  }
  return number_of(metrics["histograms"][name], percentile);
}

}  // namespace edgesplat::report
