// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <functional>

namespace CLI {  // NOLINT(readability-identifier-naming): the library's
class App;       // CLI11 costs 10 s a file: only main.cpp and the *_verb.cpp files include it
}

namespace edgesplat::desk {

/// What the command line asked for: the callback of the chosen verb's subcommand stores its work here, main
/// runs it after parsing. Words go to stderr; with --json a verb prints one JSON line on stdout.
struct VerbContext {
  std::function<Status()> work;
};

// One verb each, in <verb>_verb.cpp: adds its subcommand with options to `app`. The context outlives parsing.
void add_convert_verb(CLI::App& app, VerbContext& context);
void add_evaluate_verb(CLI::App& app, VerbContext& context);
void add_inspect_verb(CLI::App& app, VerbContext& context);
void add_odometry_verb(CLI::App& app, VerbContext& context);
void add_recover_verb(CLI::App& app, VerbContext& context);
void add_render_verb(CLI::App& app, VerbContext& context);
void add_replay_verb(CLI::App& app, VerbContext& context);
void add_report_verb(CLI::App& app, VerbContext& context);
void add_score_verb(CLI::App& app, VerbContext& context);
void add_simulate_verb(CLI::App& app, VerbContext& context);
void add_stream_verb(CLI::App& app, VerbContext& context);
void add_train_verb(CLI::App& app, VerbContext& context);

}  // namespace edgesplat::desk
