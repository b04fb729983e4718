// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/html_page.hpp"
#include "tools/report/losses.hpp"
#include "tools/report/sections.hpp"

namespace edgesplat::report {

std::string losses_section(const RunFolder& run) {
  const Losses found = find_losses(run.robot_metrics, run.server_metrics);
  std::vector<std::vector<std::string>> rows = {{"counter", "count"}};
  for (const Loss& loss : found.losses) rows.push_back({loss.program + " " + loss.name, loss.count.dump()});
  std::string body;
  if (!found.losses.empty()) body += html_table(rows);
  if (found.counted()) {
    body += html_paragraph((found.losses.empty() ? "All " : "Another ") + std::to_string(found.zero) +
                           " counters of losses, refusals and gaps are 0.");
  } else {
    body += html_paragraph("The run counted nothing: metrics.json is missing.");
  }
  return html_section("Drops and losses", body);
}

}  // namespace edgesplat::report
