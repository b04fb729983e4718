// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/link_figures.hpp"

#include "tools/report/run_metrics.hpp"

#include <cmath>

namespace edgesplat::report {
namespace {

nlohmann::json or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

void add_modes(const std::optional<ModeFigures>& modes, nlohmann::json& summary) {
  for (const char* key :
       {"mode_seconds", "mode_switches", "bytes_up_per_s_full", "bytes_up_per_s_lean", "bytes_down_per_s"}) {
    summary[key] = nullptr;
  }
  if (!modes) return;
  for (std::size_t mode = 0; mode < kRunModeNames.size(); ++mode)
    summary["mode_seconds"][kRunModeNames[mode]] = modes->seconds[mode];
  summary["mode_switches"] = modes->switches;
  summary["bytes_up_per_s_full"] = or_null(modes->bytes_up_per_s[index_of(RunMode::kFull)]);
  summary["bytes_up_per_s_lean"] = or_null(modes->bytes_up_per_s[index_of(RunMode::kLean)]);
  summary["bytes_down_per_s"] = or_null(modes->bytes_down_per_s);
}

}  // namespace

LinkFigures link_figures(const RunFolder& run) {
  LinkFigures figures;
  if (!run.modes.samples.empty()) figures.modes = figures_of(run.modes);
  figures.delta_latency_ms_p95 = find_histogram(run.server_metrics, "server.keyframe_to_delta_ms", "p95");
  figures.hash_agreed = find_metric(run.robot_metrics, {"map.hash_agreed"}).value_or(0.0);
  figures.hash_disagreed = find_metric(run.robot_metrics, {"map.hash_disagreed"}).value_or(0.0);
  if (figures.hash_disagreed > 0.0) {
    figures.map_hash_match = false;
  } else if (figures.hash_agreed > 0.0) {
    figures.map_hash_match = true;
  }
  const Losses losses = find_losses(run.robot_metrics, run.server_metrics);
  if (losses.counted()) figures.losses = losses;
  return figures;
}

void add_to_json(const LinkFigures& figures, nlohmann::json& summary) {
  add_modes(figures.modes, summary);
  summary["delta_latency_ms_p95"] = or_null(figures.delta_latency_ms_p95);
  summary["map_hash_match"] =
      figures.map_hash_match ? nlohmann::json(*figures.map_hash_match) : nlohmann::json(nullptr);
  summary["dropped"] = nullptr;
  if (!figures.losses) return;
  summary["dropped"] = nlohmann::json::object();
  for (const Loss& loss : figures.losses->losses)
    summary["dropped"][loss.program + "." + loss.name] = loss.count;
}

}  // namespace edgesplat::report
