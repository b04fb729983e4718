// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/verbs.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <string>

namespace edgesplat::desk {
namespace {

struct EvaluateOptions {
  std::string estimate;
  std::string reference;
  bool json = false;
};

Status evaluate(const EvaluateOptions& options) {
  return fail(Errc::kUnavailable, "cannot evaluate " + options.estimate + " yet");
}

}  // namespace

void add_evaluate_verb(CLI::App& app, VerbContext& context) {
  auto* verb = app.add_subcommand("evaluate", "Compare an estimated trajectory with a reference");
  auto options = std::make_shared<EvaluateOptions>();
  verb->add_option("--estimate", options->estimate, "Estimated trajectory, TUM format")->required();
  verb->add_option("--reference", options->reference, "Reference trajectory")->required();
  verb->add_flag("--json", options->json, "Print one JSON line on stdout");
  verb->callback([options, &context] { context.work = [options] { return evaluate(*options); }; });
}

}  // namespace edgesplat::desk
