// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/html_page.hpp"
#include "tools/report/sections.hpp"

namespace edgesplat::report {

std::string headline_section(const Summary& summary) {
  std::string cards = "<div class=\"cards\">\n";
  for (const SummaryRow& row : summary_rows(summary)) cards += html_figure_card(row.label, row.value);
  return "<section>" + cards + "</div></section>\n";
}

}  // namespace edgesplat::report
