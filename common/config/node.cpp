// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/config/node.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace edgesplat::config {

const Node* find(const Table& table, std::string_view key) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const Entry& e) { return e.key == key; });
  return found == table.end() ? nullptr : &found->node;
}

void merge(Table& into, Table&& from) {
  for (auto& [key, node] : from) {
    const auto found = std::find_if(into.begin(), into.end(), [&](const Entry& e) { return e.key == key; });
    if (found == into.end()) {
      into.push_back({std::move(key), std::move(node)});
      continue;
    }
    auto* old_table = std::get_if<Table>(&found->node.value);
    auto* new_table = std::get_if<Table>(&node.value);
    if (old_table != nullptr && new_table != nullptr) {
      merge(*old_table, std::move(*new_table));
    } else {
      found->node = std::move(node);
    }
  }
}

std::string_view kind_name(const Node& node) {
  constexpr std::array<std::string_view, 7> kNames{
      "a date or time", "true or false", "a whole number", "a number", "a text", "a list", "a table"};
  return kNames[node.value.index()];
}

}  // namespace edgesplat::config
