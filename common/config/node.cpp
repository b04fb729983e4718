// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/config/node.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>
#include <utility>

namespace edgesplat::config {

const Node* find(const Table& table, std::string_view key) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const Entry& e) { return e.key == key; });
  return found == table.end() ? nullptr : &found->node;
}

namespace {

bool is_list_of_tables(const Node& node) {
  const auto* items = std::get_if<std::vector<Node>>(&node.value);
  return items != nullptr && !items->empty() &&
         std::all_of(items->begin(), items->end(),
                     [](const Node& item) { return std::holds_alternative<Table>(item.value); });
}

/// The tables of a list are named by their places, from 0.
Status merge_into_list(std::string_view key, std::vector<Node>& items, Table&& from) {
  for (auto& [place, node] : from) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(place.data(), place.data() + place.size(), index);
    auto* inside = std::get_if<Table>(&node.value);
    const bool is_place = error == std::errc{} && end == place.data() + place.size() && index < items.size();
    if (!is_place || inside == nullptr) {
      const std::string name(key);
      return fail(Errc::kInvalidConfig, name + " are " + std::to_string(items.size()) + ": say which, as " +
                                            name + ".0.KEY to " + name + "." +
                                            std::to_string(items.size() - 1) + ".KEY");
    }
    if (Status status = merge(std::get<Table>(items[index].value), std::move(*inside)); !status)
      return status;
  }
  return {};
}

}  // namespace

Status merge(Table& into, Table&& from) {
  for (auto& [key, node] : from) {
    const auto found = std::find_if(into.begin(), into.end(), [&](const Entry& e) { return e.key == key; });
    if (found == into.end()) {
      into.push_back({std::move(key), std::move(node)});
      continue;
    }
    auto* old_table = std::get_if<Table>(&found->node.value);
    auto* new_table = std::get_if<Table>(&node.value);
    Status merged;
    if (new_table != nullptr && is_list_of_tables(found->node)) {
      merged = merge_into_list(key, std::get<std::vector<Node>>(found->node.value), std::move(*new_table));
    } else if (old_table != nullptr && new_table != nullptr) {
      merged = merge(*old_table, std::move(*new_table));
    } else {
      found->node = std::move(node);
    }
    if (!merged) return merged;
  }
  return {};
}

std::string_view kind_name(const Node& node) {
  constexpr std::array<std::string_view, 7> kNames{
      "a date or time", "true or false", "a whole number", "a number", "a text", "a list", "a table"};
  return kNames[node.value.index()];
}

}  // namespace edgesplat::config
