// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/verbs.hpp"
#include "tools/report/report.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>

namespace edgesplat::desk {
namespace {

Status run_report(const report::ReportOptions& options, bool json) {
  EDGESPLAT_TRY(const report::Report written, report::write_report(options));
  if (json) {
    std::printf("%s\n", report::to_json(written.summary, written.references).dump().c_str());
  } else {
    std::fputs(report::to_text(written).c_str(), stderr);
  }
  return {};
}

}  // namespace

void add_report_verb(CLI::App& app, VerbContext& context) {
  auto* verb = app.add_subcommand("report", "Write report.html and summary.json of a run");
  auto options = std::make_shared<report::ReportOptions>();
  auto json = std::make_shared<bool>(false);
  verb->add_option("--run", options->run, "The run folder")->required();
  verb->add_option("--input", options->input,
                   "What was replayed or streamed, for its truth: .mcap or folder");
  verb->add_option("--keyframes", options->max_keyframes, "Camera pictures shown at most")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  verb->add_flag("--json", *json, "Print the summary as one JSON line on stdout");
  verb->callback(
      [options, json, &context] { context.work = [options, json] { return run_report(*options, *json); }; });
}

}  // namespace edgesplat::desk
