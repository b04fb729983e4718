// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/html_page.hpp"
#include "tools/report/sections.hpp"

namespace edgesplat::report {

std::string settings_section(const RunFolder& run) {
  std::string body;
  if (!run.robot_toml.empty())
    body += html_details("robot.toml: the effective configuration", run.robot_toml);
  if (!run.rig_toml.empty()) body += html_details("rig.toml: the sensors and where they sit", run.rig_toml);
  if (run.robot_metrics.is_object())
    body += html_details("All metrics of the robot", run.robot_metrics.dump(2));
  if (run.server_metrics.is_object())
    body += html_details("All metrics of the server", run.server_metrics.dump(2));
  if (!run.missing.empty()) {
    std::vector<std::vector<std::string>> rows = {{"What this report lacks"}};
    for (const std::string& sentence : run.missing) rows.push_back({sentence});
    body += html_table(rows);
  }
  body += html_paragraph("Written by edgesplat " EDGESPLAT_VERSION ".");
  return html_section("Settings", body);
}

}  // namespace edgesplat::report
