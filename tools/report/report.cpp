// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/report.hpp"

#include "common/io/atomic_file.hpp"
#include "tools/report/html_page.hpp"
#include "tools/report/sections.hpp"

#include <fmt/format.h>

namespace edgesplat::report {
namespace {

constexpr std::size_t kPatchPictures = 4;

}  // namespace

Result<Report> write_report(const ReportOptions& options) {
  EDGESPLAT_TRY(RunFolder run, read_run_folder(options.run));
  Report report;
  report.references = find_references(run, options.input);
  const auto pictures = keyframe_pictures(run, options.max_keyframes);
  std::vector<RenderQuality> qualities;
  for (const KeyframePictures& picture : pictures) {
    if (picture.quality) qualities.push_back(*picture.quality);
  }
  report.summary = summarise(run, report.references, qualities);
  report.page = options.run / "report.html";

  std::string body = headline_section(report.summary);
  body += trajectory_section(run, report.references);
  body += map_section(run);
  body += held_out_section(run, options.max_keyframes);
  body += camera_section(pictures);
  body += tracking_section(run, patch_pictures(run, kPatchPictures));
  body += timing_section(run);
  body += modes_section(run, report.summary.link);
  body += losses_section(run);
  body += settings_section(run);
  report.missing = run.missing;
  const std::string title = "edgesplat run " + std::filesystem::absolute(options.run).filename().string();
  EDGESPLAT_TRY_STATUS(io::write_file_atomically(report.page, html_page(title, body)));
  const std::string summary = to_json(report.summary, report.references).dump(2) + "\n";
  EDGESPLAT_TRY_STATUS(io::write_file_atomically(options.run / "summary.json", summary));
  if (!run.trajectory.empty()) {
    EDGESPLAT_TRY_STATUS(io::write_tum(options.run / "trajectory.tum", run.trajectory));
  }
  return report;
}

std::string to_text(const Report& report) {
  std::string text;
  for (const SummaryRow& row : summary_rows(report.summary))
    text += fmt::format("  {:<34}{}\n", row.label, row.value);
  for (const Reference& reference : report.references) {
    text += fmt::format("  {:<34}ATE {:.3f} m, ETE {:.3f} m\n", "against " + reference.name,
                        reference.evaluation.absolute_m.rmse, reference.evaluation.end_to_end.distance_m);
  }
  for (const std::string& sentence : report.missing) text += "  not in the report: " + sentence + "\n";
  return text + fmt::format("  {:<34}{}\n", "Report", report.page.string());
}

}  // namespace edgesplat::report
