// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/verbs.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>

namespace {

constexpr int kExitUsage = 2;

}  // namespace

int main(int argc, char** argv) {
  using namespace edgesplat;
  CLI::App app{"edgesplat: simulate, replay, evaluate and report runs of the mapping system", "edgesplat"};
  app.set_version_flag("--version", "edgesplat " EDGESPLAT_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 failed, 2 usage or configuration. `edgesplat VERB --help` explains a verb.");
  desk::VerbContext context;
  desk::add_convert_verb(app, context);
  desk::add_evaluate_verb(app, context);
  desk::add_inspect_verb(app, context);
  desk::add_odometry_verb(app, context);
  desk::add_recover_verb(app, context);
  desk::add_render_verb(app, context);
  desk::add_replay_verb(app, context);
  desk::add_report_verb(app, context);
  desk::add_score_verb(app, context);
  desk::add_simulate_verb(app, context);
  desk::add_stream_verb(app, context);
  desk::add_train_verb(app, context);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  const Status status = context.work();
  if (status) return 0;
  std::fprintf(stderr, "edgesplat: %s\n", status.error().context.c_str());
  return exit_code(status.error());
}
