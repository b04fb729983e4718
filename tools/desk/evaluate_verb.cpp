// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/accuracy/evaluation_text.hpp"
#include "tools/desk/verbs.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <string>

namespace edgesplat::desk {
namespace {

struct EvaluateOptions {
  std::string estimate;
  accuracy::ReferenceSource reference;
  double max_diff_s = 0.01;
  bool json = false;
};

Status run_evaluate(const EvaluateOptions& options) {
  EDGESPLAT_TRY(const auto estimate, io::read_tum(options.estimate));
  if (estimate.empty()) return fail(Errc::kInvalidArgument, options.estimate + " holds no pose");
  EDGESPLAT_TRY(const auto reference, accuracy::read_reference(options.reference, estimate.front().stamp));
  EDGESPLAT_TRY(
      const accuracy::Evaluation evaluation,
      accuracy::evaluate(accuracy::associate(estimate, reference, from_seconds(options.max_diff_s))));
  std::FILE* const out = options.json ? stdout : stderr;
  const std::string text =
      options.json ? accuracy::to_json(evaluation).dump() + "\n" : accuracy::to_text(evaluation);
  std::fputs(text.c_str(), out);
  return {};
}

}  // namespace

void add_evaluate_verb(CLI::App& app, VerbContext& context) {
  auto* verb = app.add_subcommand("evaluate", "Compare an estimated trajectory with a reference");
  auto options = std::make_shared<EvaluateOptions>();
  verb->add_option("--estimate", options->estimate, "Estimated trajectory, TUM format")->required();
  verb->add_option("--reference", options->reference.path, "Reference trajectory")->required();
  verb->add_option("--reference-format", options->reference.format, "tum or kitti")
      ->transform(CLI::CheckedTransformer(std::map<std::string, accuracy::ReferenceFormat>{
          {"tum", accuracy::ReferenceFormat::kTum}, {"kitti", accuracy::ReferenceFormat::kKitti}}));
  verb->add_option("--times", options->reference.times, "KITTI reference: times.txt with its stamps");
  verb->add_option("--rate", options->reference.rate_hz,
                   "KITTI reference without --times: poses a second, from time 0, or from the estimate's "
                   "first stamp where that lies outside")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--max-diff", options->max_diff_s, "Largest difference of paired stamps, seconds")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_flag("--json", options->json, "Print one JSON line on stdout");
  verb->callback([options, &context] { context.work = [options] { return run_evaluate(*options); }; });
}

}  // namespace edgesplat::desk
