// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <filesystem>

namespace edgesplat::desk {

struct ScoreOptions {
  std::filesystem::path run;  ///< run folder with robot/gaussians_at_input_end.ply and robot/keyframes
  /// The simulated recording that was streamed or replayed; empty: a real run with robot/heldout.
  std::filesystem::path input;
  std::size_t views = 24;             ///< at most
  std::filesystem::path lpips_model;  ///< folder of the LPIPS network; empty or absent: no LPIPS
  std::filesystem::path mask_model;   ///< folder of StaticMask's network; empty or absent: every pixel counts
};

/// Draws the robot's own map from places that it was not made from and compares: from true poses between its
/// keyframes with the clean simulated world, or from the tracked poses of pictures held out of mapping with
/// those pictures, of which what can move does not count. Writes run/heldout/ (pictures) and
/// run/heldout.json, and returns that file's content. kNotFound where something of the run is missing, the
/// recording has no world or nothing was held out.
[[nodiscard]] Result<nlohmann::json> score_run(const ScoreOptions& options);

}  // namespace edgesplat::desk
