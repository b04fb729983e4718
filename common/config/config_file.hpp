// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/config/config_reader.hpp"
#include "common/config/node.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace edgesplat::config {

/// A parsed TOML file with command-line overrides on top. Single-owner.
class ConfigFile {
 public:
  /// No file: defaults and overrides only.
  ConfigFile() = default;
  /// Errors: kInvalidConfig "NAME:LINE: reason" where the text is not TOML.
  static Result<ConfigFile> parse(std::string_view text, std::string name);
  /// The same, from a file; kNotFound or kIo where it cannot be read.
  static Result<ConfigFile> load(const std::filesystem::path& path);

  /// `--set key.path=value`; later ones win. The value is TOML; a text needs no quotes.
  Status apply_override(std::string_view assignment);

  /// Sets every field that the file names and checks it against its `describe(ConfigReader&, Config&)`, which
  /// is found next to Config. Unknown keys, wrong types, values out of range: one kInvalidConfig error that
  /// lists all of them, one a line, "NAME:LINE: key: what is wrong". Fields in error keep their default.
  template <typename Config>
  [[nodiscard]] Status read_into(Config& config) const {
    return read([&config](ConfigReader& reader) { describe(reader, config); });
  }
  /// The same with any visitor.
  [[nodiscard]] Status read(const std::function<void(ConfigReader&)>& describe_all) const;

 private:
  std::string name_ = "configuration";
  Table root_;
};

/// The fields that `describe_all` visits as commented TOML with their present values: --print-config, and the
/// copy in each recording. Reading the text gives the same config again.
[[nodiscard]] std::string print_toml(const std::function<void(ConfigReader&)>& describe_all);

template <typename Config>
[[nodiscard]] std::string to_toml(Config config) {
  return print_toml([&config](ConfigReader& reader) { describe(reader, config); });
}

}  // namespace edgesplat::config
