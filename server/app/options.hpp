// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "server/config/server_config.hpp"

#include <filesystem>
#include <optional>

namespace edgesplat::app {

/// What the command line asks for.
struct Options {
  enum class Action { kRun, kCheckConfig, kPrintConfig, kDone };
  Action action = Action::kRun;
  config::ServerConfig config;
  std::filesystem::path out = "out/server-run";
  std::optional<double> idle_exit_s;
};

/// Parses the command line and the configuration. kDone: help or version was printed. Errors: kInvalidConfig.
[[nodiscard]] Result<Options> parse_options(int argc, const char* const* argv);

}  // namespace edgesplat::app
