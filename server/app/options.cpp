// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/app/options.hpp"

#include "common/config/config_file.hpp"

#include <CLI/CLI.hpp>

#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace edgesplat::app {
namespace {

struct Raw {
  std::string config_path;
  std::vector<std::string> overrides;
  bool check = false;
  bool print = false;
  std::optional<std::string> interface;
  std::optional<int> domain;
};

void declare(CLI::App& app, Raw& raw, Options& options) {
  app.set_version_flag("--version", "edgesplat-server " EDGESPLAT_VERSION);
  app.add_option("--config", raw.config_path, "TOML file");
  app.add_option("--set", raw.overrides, "one setting over the file, KEY=VALUE (can be repeated)");
  app.add_flag("--check-config", raw.check, "read the configuration, say what is wrong with it, end");
  app.add_flag("--print-config", raw.print, "print the effective configuration as TOML, end");
  app.add_option("--interface", raw.interface, "network interface, the same as --set link.interface=NAME");
  app.add_option("--domain", raw.domain, "DDS domain, the same as --set link.domain=N");
  app.add_option("--out", options.out, "run folder; metrics go to DIR/server")->capture_default_str();
  app.add_option("--idle-exit", options.idle_exit_s, "end after S seconds without a keyframe");
  app.footer("Ends cleanly on SIGTERM and SIGINT. Exit codes: 0 done, 1 failed, 2 usage or configuration.");
}

Result<config::ServerConfig> read_config(const Raw& raw) {
  config::ConfigFile file;
  if (!raw.config_path.empty()) {
    auto loaded = config::ConfigFile::load(raw.config_path);
    if (!loaded) return fail(Errc::kInvalidConfig, loaded.error().context);
    file = std::move(*loaded);
  }
  std::vector<std::string> overrides = raw.overrides;
  if (raw.interface) overrides.push_back("link.interface=\"" + *raw.interface + "\"");
  if (raw.domain) overrides.push_back("link.domain=" + std::to_string(*raw.domain));
  for (const std::string& assignment : overrides) EDGESPLAT_TRY_STATUS(file.apply_override(assignment));
  config::ServerConfig config;
  EDGESPLAT_TRY_STATUS(file.read_into(config));
  return config;
}

}  // namespace

Result<Options> parse_options(int argc, const char* const* argv) {
  Options options;
  Raw raw;
  CLI::App app{"edgesplat-server: builds the maps of the robots that connect to it", "edgesplat-server"};
  declare(app, raw, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream words;
    if (app.exit(error, std::cout, words) != 0) return fail(Errc::kInvalidConfig, words.str());
    options.action = Options::Action::kDone;
    return options;
  }
  EDGESPLAT_TRY(options.config, read_config(raw));
  if (raw.check) options.action = Options::Action::kCheckConfig;
  if (raw.print) options.action = Options::Action::kPrintConfig;
  return options;
}

}  // namespace edgesplat::app
