// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <filesystem>

namespace edgesplat::desk {

struct ScoreOptions {
  std::filesystem::path run;    ///< run folder with robot/gaussians_at_input_end.ply and robot/keyframes
  std::filesystem::path input;  ///< the simulated recording that was streamed or replayed
  std::size_t views = 24;       ///< at most
  std::filesystem::path lpips_model;  ///< folder of the LPIPS network; empty or absent: no LPIPS
};

/// Draws the robot's own map from true poses between its keyframes and compares with the clean simulated
/// world. Writes run/heldout/ (pictures) and run/heldout.json, and returns that file's content. kNotFound
/// where something of the run is missing or the recording has no world.
[[nodiscard]] Result<nlohmann::json> score_run(const ScoreOptions& options);

}  // namespace edgesplat::desk
