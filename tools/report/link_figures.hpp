// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/report/losses.hpp"
#include "tools/report/run_folder.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>

namespace edgesplat::report {

/// What the run says of the two programs working together. Nothing where its source is missing.
struct LinkFigures {
  std::optional<ModeFigures> modes;
  /// From a keyframe's arrival at the server to its delta (server.keyframe_to_delta_ms): the link's own part
  /// of the delay is not in it.
  std::optional<double> delta_latency_ms_p95;
  /// The robot compares its map's hash with the server's whenever both are at the same delta. True where
  /// every comparison agreed, the last one with them; false where one did not, even if the maps were brought
  /// together again afterwards; nothing where there was none, as without a server.
  std::optional<bool> map_hash_match;
  double hash_agreed = 0.0;
  double hash_disagreed = 0.0;
  std::optional<Losses> losses;
};

[[nodiscard]] LinkFigures link_figures(const RunFolder& run);

/// mode_seconds {LOCAL, LEAN, FULL}, mode_switches, bytes_up_per_s_full, bytes_up_per_s_lean,
/// bytes_down_per_s, delta_latency_ms_p95, map_hash_match and dropped {"robot.NAME": count}; null for what
/// does not apply.
void add_to_json(const LinkFigures& figures, nlohmann::json& summary);

}  // namespace edgesplat::report
