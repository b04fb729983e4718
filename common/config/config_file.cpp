// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_file.hpp"

#include "common/config/config_loader.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace edgesplat::config {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

bool is_key_path(std::string_view key) {
  constexpr std::size_t kLongest = 256;
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  return !key.empty() && key.size() <= kLongest && std::all_of(key.begin(), key.end(), allowed);
}

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

void mark_as_override(Table& table) {
  for (Entry& entry : table) {
    entry.node.line = 0;
    if (auto* inside = std::get_if<Table>(&entry.node.value)) mark_as_override(*inside);
  }
}

}  // namespace

Result<ConfigFile> ConfigFile::parse(std::string_view text, std::string name) {
  ConfigFile file;
  file.name_ = std::move(name);
  EDGESPLAT_TRY(file.root_, parse_toml(text, file.name_));
  return file;
}

Result<ConfigFile> ConfigFile::load(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    return fail(Errc::kNotFound,
                "no configuration file " + path.string() + ": check the path after --config");
  std::ifstream stream(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream.good() && !stream.eof())
    return fail(Errc::kIo, "cannot read " + path.string() + ": check its permissions");
  return parse(text, path.string());
}

Status ConfigFile::apply_override(std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string_view key = trimmed(assignment.substr(0, std::min(equals, assignment.size())));
  if (equals == std::string_view::npos || !is_key_path(key))
    return fail(Errc::kInvalidConfig, "--set " + std::string(assignment) +
                                          ": write --set key=value, with dots between table and key");
  const std::string_view value = trimmed(assignment.substr(equals + 1));
  const std::string left = std::string(key) + " = ";
  // A bare word is no TOML value: take it as a text. A line break would start a second assignment.
  const bool one_line = value.find('\n') == std::string_view::npos;
  Result<Table> parsed =
      one_line ? parse_toml(left + std::string(value), "--set") : fail(Errc::kInvalidConfig, "");
  if (!parsed) parsed = parse_toml(left + quoted(value), "--set");
  if (!parsed)
    return fail(Errc::kInvalidConfig, "--set " + std::string(assignment) + ": " + parsed.error().context);
  mark_as_override(*parsed);
  const Status merged = merge(root_, std::move(*parsed));
  if (!merged)
    return fail(Errc::kInvalidConfig, "--set " + std::string(assignment) + ": " + merged.error().context);
  return {};
}

Status ConfigFile::read(const std::function<void(ConfigReader&)>& describe_all) const {
  ConfigLoader loader(root_, name_);
  describe_all(loader);
  return loader.finish();
}

}  // namespace edgesplat::config
