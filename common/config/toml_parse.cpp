// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The only file that includes toml++.
#include "common/config/node.hpp"

#include <toml++/toml.h>

#include <algorithm>

namespace edgesplat::config {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 20U;
constexpr int kMostDots = 256;

/// toml++ limits nested brackets to 256 but not dotted keys (a.a.a.a...), whose tables are freed by
/// recursion.
bool dotted_too_deep(std::string_view text) {
  int dots = 0;
  for (const char c : text) {
    if (c == '.') {
      if (++dots > kMostDots) return true;
    } else if (c == '\n' || c == '=' || c == ',' || c == '[' || c == '{') {
      dots = 0;
    }
  }
  return false;
}

Node convert(const toml::node& from);

Table convert_table(const toml::table& from) {
  Table out;
  out.reserve(from.size());
  for (const auto& [key, value] : from) out.push_back({std::string(key.str()), convert(value)});
  // toml++ sorts by key; people read files from the top.
  std::stable_sort(out.begin(), out.end(),
                   [](const Entry& a, const Entry& b) { return a.node.line < b.node.line; });
  return out;
}

Node convert(const toml::node& from) {
  Node out;
  out.line = static_cast<int>(from.source().begin.line);
  if (const auto* flag = from.as_boolean()) {
    out.value = flag->get();
  } else if (const auto* integer = from.as_integer()) {
    out.value = integer->get();
  } else if (const auto* number = from.as_floating_point()) {
    out.value = number->get();
  } else if (const auto* text = from.as_string()) {
    out.value = text->get();
  } else if (const auto* array = from.as_array()) {
    std::vector<Node> items;
    items.reserve(array->size());
    for (const toml::node& item : *array) items.push_back(convert(item));
    out.value = std::move(items);
  } else if (const auto* table = from.as_table()) {
    out.value = convert_table(*table);
  }
  return out;
}

}  // namespace

Result<Table> parse_toml(std::string_view text, std::string_view name) {
  const auto at = [&](auto line) { return std::string(name) + ":" + std::to_string(line) + ": "; };
  if (text.size() > kMostBytes)
    return fail(Errc::kInvalidConfig, at(1) + "larger than 1 MiB: this is not a configuration file");
  if (dotted_too_deep(text)) return fail(Errc::kInvalidConfig, at(1) + "a key with more than 256 dots");
  try {
    return convert_table(toml::parse(text));
  } catch (const toml::parse_error& error) {
    return fail(Errc::kInvalidConfig, at(error.source().begin.line) + std::string(error.description()));
  }
}

}  // namespace edgesplat::config
