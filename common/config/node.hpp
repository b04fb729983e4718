// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace edgesplat::config {

struct Entry;
/// Entries in the order of the file; keys are unique.
using Table = std::vector<Entry>;

/// One value of a configuration file with its place: what the rest of common/config sees of TOML.
struct Node {
  /// monostate: a TOML date or time, which no field of the project takes.
  std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<Node>, Table> value;
  int line = 0;  ///< 1-based; 0 for a value set on the command line
};

/// A struct, since clang refuses std::pair of a type that is not complete yet.
struct Entry {
  std::string key;
  Node node;
};

/// The value at `key`, or null.
[[nodiscard]] const Node* find(const Table& table, std::string_view key);
/// Puts `from` into `into`: tables are merged, also those of a list by their place (lidar.1.name), anything
/// else is replaced. kInvalidConfig where a place is none of the list's, or is not said.
[[nodiscard]] Status merge(Table& into, Table&& from);
/// "a table", "a whole number", ...: for messages.
[[nodiscard]] std::string_view kind_name(const Node& node);

/// Parses TOML 1.0. Errors: kInvalidConfig, "NAME:LINE: ..." with the parser's reason; also for a text over
/// 1 MiB and for nesting deeper than 256 levels.
[[nodiscard]] Result<Table> parse_toml(std::string_view text, std::string_view name);

}  // namespace edgesplat::config
