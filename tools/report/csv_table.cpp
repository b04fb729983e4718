// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/csv_table.hpp"

#include <charconv>
#include <limits>

namespace edgesplat::report {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

double to_number(const std::string& text) {
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = result.ec == std::errc{} && result.ptr == text.data() + text.size();
  return whole ? value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Result<CsvTable> CsvTable::parse(std::string_view text, std::string_view file_name) {
  CsvTable table;
  std::size_t line_number = 0;
  for (std::string_view line : split(text, '\n')) {
    ++line_number;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.empty()) continue;
    const auto fields = split(line, ',');
    if (table.names_.empty()) {
      table.names_.assign(fields.begin(), fields.end());
      continue;
    }
    if (fields.size() != table.names_.size()) {
      return fail(Errc::kCorrupt, std::string(file_name) + ":" + std::to_string(line_number) + ": " +
                                      std::to_string(fields.size()) + " fields, the header has " +
                                      std::to_string(table.names_.size()));
    }
    for (std::size_t i = 0; i < fields.size(); ++i) table.columns_[table.names_[i]].emplace_back(fields[i]);
    ++table.rows_;
  }
  return table;
}

std::vector<std::string> CsvTable::texts(const std::string& column) const {
  const auto found = columns_.find(column);
  return found == columns_.end() ? std::vector<std::string>{} : found->second;
}

std::vector<double> CsvTable::numbers(const std::string& column) const {
  std::vector<double> values;
  for (const std::string& text : texts(column)) values.push_back(to_number(text));
  return values;
}

std::vector<std::string> CsvTable::names_ending(std::string_view suffix) const {
  std::vector<std::string> names;
  for (const std::string& name : names_) {
    if (name.ends_with(suffix)) names.push_back(name);
  }
  return names;
}

}  // namespace edgesplat::report
