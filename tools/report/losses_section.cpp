// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/html_page.hpp"
#include "tools/report/sections.hpp"

#include <algorithm>
#include <array>

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

struct LossRows {
  std::vector<std::vector<std::string>> rows;
  std::size_t zero = 0;
};

void collect(const nlohmann::json& metrics, const std::string& program, LossRows& losses) {
  if (!metrics.is_object() || !metrics.contains("counters")) return;
  for (const auto& [name, value] : metrics["counters"].items()) {
    if (!tells_of_loss(name) || !value.is_number()) continue;
    if (value.get<double>() == 0.0) {
      ++losses.zero;
    } else {
      losses.rows.push_back({program + " " + name, value.dump()});
    }
  }
}

}  // namespace

std::string losses_section(const RunFolder& run) {
  LossRows losses;
  losses.rows.push_back({"counter", "count"});
  collect(run.robot_metrics, "robot", losses);
  collect(run.server_metrics, "server", losses);
  std::string body;
  if (losses.rows.size() > 1) body += html_table(losses.rows);
  if (losses.zero > 0 || losses.rows.size() > 1) {
    body += html_paragraph((losses.rows.size() > 1 ? "Another " : "All ") + std::to_string(losses.zero) +
                           " counters of losses, refusals and gaps are 0.");
  } else {
    body += html_paragraph("The run counted nothing: metrics.json is missing.");
  }
  return html_section("Drops and losses", body);
}

}  // namespace edgesplat::report
