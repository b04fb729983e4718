// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace edgesplat::report {

/// json[key] where that is a number.
[[nodiscard]] std::optional<double> number_of(const nlohmann::json& json, const char* key);

/// counters[name] or gauges[name] of a metrics.json, the first of `names` that is there.
[[nodiscard]] std::optional<double> find_metric(const nlohmann::json& metrics,
                                                const std::vector<std::string>& names);

/// `percentile` ("p50", "p95", ...) of the histogram `name` of a metrics.json.
[[nodiscard]] std::optional<double> find_histogram(const nlohmann::json& metrics, const std::string& name,
                                                   const char* percentile);

}  // namespace edgesplat::report
