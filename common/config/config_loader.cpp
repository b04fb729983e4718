// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_loader.hpp"

#include "common/config/number_text.hpp"
#include "common/config/spelling.hpp"

#include <algorithm>

namespace edgesplat::config {

ConfigLoader::ConfigLoader(const Table& root, std::string name) : name_(std::move(name)) {
  scopes_.push_back({&root, "", {}});
}

Status ConfigLoader::finish() {
  report_unknown_keys(scopes_.front());
  if (problems_.empty()) return {};
  std::stable_sort(problems_.begin(), problems_.end(),
                   [](const Problem& a, const Problem& b) { return a.line < b.line; });
  std::string all;
  for (const Problem& problem : problems_) {
    if (!all.empty()) all += '\n';
    all += problem.text;
  }
  return fail(Errc::kInvalidConfig, std::move(all));
}

const Node* ConfigLoader::look_up(std::string_view key) {
  scopes_.back().known.emplace(key);
  return scopes_.back().table == nullptr ? nullptr : find(*scopes_.back().table, key);
}

void ConfigLoader::report(const Node& node, std::string_view key, const std::string& sentence) {
  const std::string place = node.line == 0 ? "--set" : name_ + ":" + std::to_string(node.line);
  problems_.push_back({node.line, place + ": " + scopes_.back().path + std::string(key) + ": " + sentence});
}

void ConfigLoader::report_type(const Node& node, std::string_view key, std::string_view wanted) {
  report(node, key, "is " + std::string(kind_name(node)) + ", must be " + std::string(wanted));
}

void ConfigLoader::problem(std::string_view key, std::string_view sentence) {
  const Node* node = look_up(key);
  // The rule may be broken by a default against a set value: then there is no line for this key.
  const std::string path = scopes_.back().path + std::string(key);
  if (node != nullptr) {
    report(*node, key, std::string(sentence));
  } else {
    problems_.push_back({0, name_ + ": " + path + ": " + std::string(sentence)});
  }
}

void ConfigLoader::report_unknown_keys(const Scope& scope) {
  if (scope.table == nullptr) return;
  for (const auto& [key, node] : *scope.table) {
    if (scope.known.contains(key)) continue;
    const std::string near = nearest_spelling(key, {scope.known.begin(), scope.known.end()});
    report(node, key, near.empty() ? "unknown key" : "unknown key, did you mean \"" + near + "\"?");
  }
}

void ConfigLoader::visit_bool(std::string_view key, bool& value, std::string_view /*doc*/) {
  const Node* node = look_up(key);
  if (node == nullptr) return;
  if (const auto* flag = std::get_if<bool>(&node->value)) {
    value = *flag;
  } else {
    report_type(*node, key, "true or false");
  }
}

void ConfigLoader::visit_text(std::string_view key, std::string& value, std::string_view /*doc*/) {
  const Node* node = look_up(key);
  if (node == nullptr) return;
  if (const auto* text = std::get_if<std::string>(&node->value)) {
    value = *text;
  } else {
    report_type(*node, key, "a text");
  }
}

void ConfigLoader::visit_integer(std::string_view key, std::int64_t& value, Range<std::int64_t> range,
                                 std::string_view /*doc*/) {
  const Node* node = look_up(key);
  if (node == nullptr) return;
  const auto* integer = std::get_if<std::int64_t>(&node->value);
  if (integer == nullptr) {
    report_type(*node, key, "a whole number");
  } else if (*integer < range.min || *integer > range.max) {
    report(*node, key,
           std::to_string(*integer) + " is out of range [" + std::to_string(range.min) + ", " +
               std::to_string(range.max) + "]");
  } else {
    value = *integer;
  }
}

std::optional<double> ConfigLoader::number(const Node& node, std::string_view key, Range<double> range) {
  double value = 0.0;
  if (const auto* floating = std::get_if<double>(&node.value)) {
    value = *floating;
  } else if (const auto* integer = std::get_if<std::int64_t>(&node.value)) {
    value = static_cast<double>(*integer);
  } else {
    report_type(node, key, "a number");
    return std::nullopt;
  }
  if (!(value >= range.min && value <= range.max)) {  // also false for NaN
    report(node, key,
           number_text(value) + " is out of range [" + number_text(range.min) + ", " +
               number_text(range.max) + "]");
    return std::nullopt;
  }
  return value;
}

bool ConfigLoader::numbers(const Node& node, std::string_view key, Range<double> range,
                           std::vector<double>& out) {
  const auto* items = std::get_if<std::vector<Node>>(&node.value);
  if (items == nullptr) {
    report_type(node, key, "a list of numbers");
    return false;
  }
  bool good = true;
  for (const Node& item : *items) {
    const std::optional<double> value = number(item, key, range);
    good = good && value.has_value();
    out.push_back(value.value_or(0.0));
  }
  return good;
}

void ConfigLoader::visit_numbers(std::string_view key, std::span<double> values, Range<double> range,
                                 std::string_view /*doc*/, Shape shape) {
  const Node* node = look_up(key);
  if (node == nullptr) return;
  std::vector<double> read;
  if (shape == Shape::kScalar) {
    const std::optional<double> value = number(*node, key, range);
    if (!value) return;
    read.push_back(*value);
  } else if (!numbers(*node, key, range, read)) {
    return;
  } else if (read.size() != values.size()) {
    report(*node, key,
           "has " + std::to_string(read.size()) + " numbers, must have " + std::to_string(values.size()));
    return;
  }
  std::copy(read.begin(), read.end(), values.begin());
}

void ConfigLoader::visit_list(std::string_view key, std::vector<double>& values, Range<double> range,
                              std::string_view /*doc*/, Range<std::size_t> length) {
  const Node* node = look_up(key);
  if (node == nullptr) return;
  std::vector<double> read;
  if (!numbers(*node, key, range, read)) return;
  if (read.size() < length.min || read.size() > length.max) {
    report(*node, key,
           "has " + std::to_string(read.size()) + " numbers, must have " + std::to_string(length.min) +
               " to " + std::to_string(length.max));
    return;
  }
  values = std::move(read);
}

void ConfigLoader::visit_choice(std::string_view key, std::size_t& index,
                                std::span<const std::string_view> allowed, std::string_view /*doc*/) {
  const Node* node = look_up(key);
  if (node == nullptr) return;
  const auto* text = std::get_if<std::string>(&node->value);
  if (text == nullptr) {
    report_type(*node, key, "a text");
    return;
  }
  const auto found = std::find(allowed.begin(), allowed.end(), *text);
  if (found != allowed.end()) {
    index = static_cast<std::size_t>(found - allowed.begin());
    return;
  }
  std::string names;
  for (const std::string_view name : allowed) names.append(names.empty() ? "" : ", ").append(name);
  report(*node, key, "\"" + *text + "\" is not one of: " + names);
}

bool ConfigLoader::begin_table(std::string_view key, std::string_view /*doc*/, bool has_value) {
  const Node* node = look_up(key);
  const Table* table = node == nullptr ? nullptr : std::get_if<Table>(&node->value);
  if (node != nullptr && table == nullptr) report_type(*node, key, "a table");
  if (table == nullptr && !has_value) return false;
  scopes_.push_back({table, scopes_.back().path + std::string(key) + ".", {}});
  return true;
}

std::size_t ConfigLoader::count_tables(std::string_view key, std::size_t present, std::size_t most) {
  const Node* node = look_up(key);
  if (node == nullptr || std::holds_alternative<Table>(node->value)) return node == nullptr ? present : 1;
  const auto* items = std::get_if<std::vector<Node>>(&node->value);
  if (items == nullptr) {
    report_type(*node, key, "a table, or several: [[" + std::string(key) + "]]");
    return present;
  }
  const auto is_table = [](const Node& item) { return std::holds_alternative<Table>(item.value); };
  if (!std::all_of(items->begin(), items->end(), is_table)) {
    report(*node, key, "every element must be a table: [[" + std::string(key) + "]]");
    return present;
  }
  if (items->empty() || items->size() > most) {
    report(*node, key, "are " + std::to_string(items->size()) + ", must be 1 to " + std::to_string(most));
    return present;
  }
  return items->size();
}

void ConfigLoader::begin_table_of(std::string_view key, std::string_view /*doc*/, std::size_t index,
                                  std::size_t count) {
  const Node* node = look_up(key);
  const Table* table = node == nullptr ? nullptr : std::get_if<Table>(&node->value);
  if (const auto* items = node == nullptr ? nullptr : std::get_if<std::vector<Node>>(&node->value);
      items != nullptr && items->size() == count)
    table = std::get_if<Table>(&(*items)[index].value);
  const std::string place =
      count == 1 ? std::string(key) : std::string(key) + "[" + std::to_string(index) + "]";
  scopes_.push_back({table, scopes_.back().path + place + ".", {}});
}

void ConfigLoader::end_table() {
  report_unknown_keys(scopes_.back());
  scopes_.pop_back();
}

}  // namespace edgesplat::config
