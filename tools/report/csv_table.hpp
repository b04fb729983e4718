// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::report {

/// A comma-separated table with a header line, column by column. No quoting: our own files have none.
class CsvTable {
 public:
  /// kCorrupt with file:line where a row has another number of fields than the header.
  static Result<CsvTable> parse(std::string_view text, std::string_view file_name);

  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] bool has(const std::string& column) const { return columns_.count(column) > 0; }
  /// Empty where there is no such column.
  [[nodiscard]] std::vector<std::string> texts(const std::string& column) const;
  /// The same as numbers; NaN where a field is none.
  [[nodiscard]] std::vector<double> numbers(const std::string& column) const;
  /// Names of the columns in the order of the file that end in `suffix`.
  [[nodiscard]] std::vector<std::string> names_ending(std::string_view suffix) const;

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::vector<std::string>> columns_;
  std::size_t rows_ = 0;
};

}  // namespace edgesplat::report
