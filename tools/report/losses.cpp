// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/losses.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace edgesplat::report {
namespace {

constexpr std::array<std::string_view, 22> kLossWords = {
    "lost",  "drop",      "refused", "late",         "overflow", "bad_",   "corrupt", "skipped",
    "gap",   "duplicate", "reject",  "coasted",      "without_", "unused", "timeout", "reset",
    "retry", "resync",    "expired", "out_of_range", "clamped",  "invalid"};

bool tells_of_loss(const std::string& name) {
  return std::any_of(kLossWords.begin(), kLossWords.end(),
                     [&](std::string_view word) { return name.find(word) != std::string::npos; });
}

void collect(const nlohmann::json& metrics, const std::string& program, Losses& found) {
  if (!metrics.is_object() || !metrics.contains("counters")) return;
  for (const auto& [name, value] : metrics["counters"].items()) {
    if (!tells_of_loss(name) || !value.is_number()) continue;
    if (value.get<double>() == 0.0) {
      ++found.zero;
    } else {
      found.losses.push_back({program, name, value});
    }
  }
}

}  // namespace

Losses find_losses(const nlohmann::json& robot_metrics, const nlohmann::json& server_metrics) {
  Losses found;
  collect(robot_metrics, "robot", found);
  collect(server_metrics, "server", found);
  return found;
}

}  // namespace edgesplat::report
