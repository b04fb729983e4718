// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/accuracy/evaluation_text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace edgesplat::accuracy {
namespace {

nlohmann::json statistics_json(const ErrorStatistics& s) {
  return {{"count", s.count},   {"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median},
          {"stddev", s.stddev}, {"min", s.min},   {"max", s.max}};
}

nlohmann::json relative_json(const RelativeErrors& errors) {
  return {{"translation_m", statistics_json(errors.translation_m)},
          {"rotation_deg", statistics_json(errors.rotation_deg)}};
}

std::string row(const char* name, const ErrorStatistics& s) {
  return fmt::format("{:<24}{:>10.4f}{:>10.4f}{:>10.4f}{:>10.4f}{:>8}\n", name, s.rmse, s.mean, s.median,
                     s.max, s.count);
}

}  // namespace

nlohmann::json to_json(const Evaluation& evaluation) {
  nlohmann::json json = {{"pairs", evaluation.pairs},
                         {"duration_s", evaluation.duration_s},
                         {"path_m", evaluation.path_m},
                         {"ate_m", statistics_json(evaluation.absolute_m)},
                         {"rpe_per_frame", relative_json(evaluation.per_frame)},
                         {"rpe_per_metre", relative_json(evaluation.per_metre)},
                         {"ete_m", evaluation.end_to_end.distance_m},
                         {"ete_percent", evaluation.end_to_end.percent_of_path},
                         {"kitti", nullptr}};
  if (evaluation.kitti) {
    json["kitti"] = {{"translation_percent", evaluation.kitti->translation_percent},
                     {"rotation_deg_per_m", evaluation.kitti->rotation_deg_per_m},
                     {"segments", evaluation.kitti->segments}};
  }
  return json;
}

std::string to_text(const Evaluation& evaluation) {
  std::string text = fmt::format("{} poses compared over {:.1f} s and {:.2f} m\n\n", evaluation.pairs,
                                 evaluation.duration_s, evaluation.path_m);
  text += fmt::format("{:<24}{:>10}{:>10}{:>10}{:>10}{:>8}\n", "", "rmse", "mean", "median", "max", "count");
  text += row("ATE (SE3 aligned), m", evaluation.absolute_m);
  text += row("RPE per frame, m", evaluation.per_frame.translation_m);
  text += row("RPE per frame, deg", evaluation.per_frame.rotation_deg);
  text += row("RPE per metre, m", evaluation.per_metre.translation_m);
  text += row("RPE per metre, deg", evaluation.per_metre.rotation_deg);
  text += fmt::format("\nend-to-end error (aligned at the start): {:.4f} m = {:.3f} % of the path\n",
                      evaluation.end_to_end.distance_m, evaluation.end_to_end.percent_of_path);
  if (evaluation.kitti) {
    text += fmt::format("KITTI: translation {:.3f} %, rotation {:.5f} deg/m over {} segments\n",
                        evaluation.kitti->translation_percent, evaluation.kitti->rotation_deg_per_m,
                        evaluation.kitti->segments);
  } else {
    text += "KITTI: no value, the path is shorter than 100 m\n";
  }
  return text;
}

}  // namespace edgesplat::accuracy
