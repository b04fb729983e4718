// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/config_reader.hpp"
#include "common/config/node.hpp"

#include <set>
#include <string>
#include <vector>

namespace edgesplat::config {

/// Fills fields from a parsed file and collects everything that is wrong with it. Borrows the table.
class ConfigLoader final : public ConfigReader {
 public:
  ConfigLoader(const Table& root, std::string name);

  /// Every problem in one error, in the order of the file; call once, after the visit.
  [[nodiscard]] Status finish();
  void problem(std::string_view key, std::string_view sentence) override;

 protected:
  void visit_bool(std::string_view key, bool& value, std::string_view doc) override;
  void visit_text(std::string_view key, std::string& value, std::string_view doc) override;
  void visit_integer(std::string_view key, std::int64_t& value, Range<std::int64_t> range,
                     std::string_view doc) override;
  void visit_numbers(std::string_view key, std::span<double> values, Range<double> range,
                     std::string_view doc, Shape shape) override;
  void visit_list(std::string_view key, std::vector<double>& values, Range<double> range,
                  std::string_view doc, Range<std::size_t> length) override;
  void visit_choice(std::string_view key, std::size_t& index, std::span<const std::string_view> allowed,
                    std::string_view doc) override;
  bool begin_table(std::string_view key, std::string_view doc, bool has_value) override;
  void end_table() override;
  std::size_t count_tables(std::string_view key, std::size_t present, std::size_t most) override;
  void begin_table_of(std::string_view key, std::string_view doc, std::size_t index,
                      std::size_t count) override;

 private:
  struct Scope {
    const Table* table;  ///< null where the file has no such table: fields keep their defaults
    std::string path;    ///< "" or "imu."
    std::set<std::string, std::less<>> known;
  };
  struct Problem {
    int line;
    std::string text;
  };

  /// The file's node for a field of the current table, or null; remembers the key as known.
  const Node* look_up(std::string_view key);
  void report(const Node& node, std::string_view key, const std::string& sentence);
  void report_type(const Node& node, std::string_view key, std::string_view wanted);
  void report_unknown_keys(const Scope& scope);
  /// The number in `node`, or nothing after a report.
  std::optional<double> number(const Node& node, std::string_view key, Range<double> range);
  bool numbers(const Node& node, std::string_view key, Range<double> range, std::vector<double>& out);

  std::string name_;
  std::vector<Scope> scopes_;
  std::vector<Problem> problems_;
};

}  // namespace edgesplat::config
