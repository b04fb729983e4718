// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::report {

/// A page with its style inside: readable on a phone, light or dark as the reader's system is. `body` is
/// HTML.
[[nodiscard]] std::string html_page(std::string_view title, std::string_view body);

/// <section> with a heading; `body` is HTML.
[[nodiscard]] std::string html_section(std::string_view heading, std::string_view body);
[[nodiscard]] std::string html_paragraph(std::string_view text);
/// First row of texts is the header. Columns after the first are aligned right.
[[nodiscard]] std::string html_table(const std::vector<std::vector<std::string>>& rows);
/// Pieces of HTML side by side where there is room: two, and pictures three, on a wide page.
[[nodiscard]] std::string html_grid(const std::vector<std::string>& pieces);
[[nodiscard]] std::string html_picture_grid(const std::vector<std::string>& pieces);
/// A picture by its data URI, with its caption below.
[[nodiscard]] std::string html_picture(std::string_view uri, std::string_view caption);
/// Text that opens on a click, e.g. a configuration file.
[[nodiscard]] std::string html_details(std::string_view heading, std::string_view text);
/// One headline figure.
[[nodiscard]] std::string html_figure_card(std::string_view label, std::string_view value);

}  // namespace edgesplat::report
