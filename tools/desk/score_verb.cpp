// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/score.hpp"
#include "tools/desk/verbs.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>

namespace edgesplat::desk {
namespace {

Status run_score(const ScoreOptions& options, bool json) {
  EDGESPLAT_TRY(nlohmann::json scores, score_run(options));
  const std::size_t views = scores["views"].size();
  scores.erase("views");
  if (json) {
    std::printf("%s\n", scores.dump().c_str());
  } else {
    std::fprintf(stderr, "%zu views: %s\nPictures: %s\n", views, scores.dump().c_str(),
                 (options.run / "heldout").string().c_str());
  }
  if (scores["kind"] == "real" && !scores["movers_masked"].get<bool>()) {
    std::fprintf(stderr, "Every pixel counts, also of what moves: there is no segmentation model in '%s'\n",
                 options.mask_model.string().c_str());
  }
  return {};
}

}  // namespace

void add_score_verb(CLI::App& app, VerbContext& context) {
  auto* verb = app.add_subcommand(
      "score",
      "Compare a run's map with the simulated world from places between keyframes, or with the pictures "
      "that the robot held out of mapping");
  auto options = std::make_shared<ScoreOptions>();
  auto json = std::make_shared<bool>(false);
  options->lpips_model = "../shared/models/lpips_alex";
  options->mask_model = "../shared/models/espnetv2_s2_city";
  verb->add_option("--run", options->run, "The run folder")->required();
  verb->add_option(
      "--input", options->input,
      "The simulated recording, .mcap; without it the pictures in RUN/robot/heldout are what should be seen");
  verb->add_option("--views", options->views, "Places at most")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb->add_option("--lpips", options->lpips_model,
                   "Folder of the LPIPS network; without it there is no LPIPS")
      ->envname("EDGESPLAT_LPIPS")
      ->capture_default_str();
  verb->add_option("--mask", options->mask_model,
                   "Folder of the segmentation model: of a held-out picture, what can move does not count; "
                   "without it every pixel counts")
      ->envname("EDGESPLAT_MASK")
      ->capture_default_str();
  verb->add_flag("--json", *json, "Print the means as one JSON line on stdout");
  verb->callback(
      [options, json, &context] { context.work = [options, json] { return run_score(*options, *json); }; });
}

}  // namespace edgesplat::desk
