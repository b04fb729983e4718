// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "tools/report/summary.hpp"

#include <filesystem>

namespace edgesplat::report {

struct ReportOptions {
  std::filesystem::path run;    ///< the run folder
  std::filesystem::path input;  ///< what was replayed or streamed, for its truth; may be empty
  std::size_t max_keyframes = 4;
};

struct Report {
  Summary summary;
  std::vector<Reference> references;
  std::vector<std::string> missing;  ///< pieces the run folder lacks, as sentences
  std::filesystem::path page;
};

/// Writes report.html (one file, nothing loaded from elsewhere), summary.json and a copy of the trajectory
/// into the run folder. Missing pieces of the run are said on the page. Errors: kNotFound for the folder,
/// kIo.
[[nodiscard]] Result<Report> write_report(const ReportOptions& options);

/// The summary as a table for a terminal.
[[nodiscard]] std::string to_text(const Report& report);

}  // namespace edgesplat::report
