// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/report/picture_embed.hpp"
#include "tools/report/references.hpp"
#include "tools/report/run_folder.hpp"
#include "tools/report/summary.hpp"

#include <string>
#include <vector>

namespace edgesplat::report {

// The sections of the page, top to bottom, as HTML; each says what it lacks instead of failing.

[[nodiscard]] std::string headline_section(const Summary& summary);
/// Against each reference: figures, both paths from above, error in x, y, z over time.
[[nodiscard]] std::string trajectory_section(const RunFolder& run, const std::vector<Reference>& references);
/// The coloured point map from above with the path on it, and obliquely.
[[nodiscard]] std::string map_section(const RunFolder& run);

/// One sampled keyframe, ready to show.
struct KeyframePictures {
  std::string html;
  std::optional<RenderQuality> quality;  ///< render against camera
};
/// Up to `limit` keyframes, evenly spread; damaged pictures are said in run.missing.
[[nodiscard]] std::vector<KeyframePictures> keyframe_pictures(RunFolder& run, std::size_t limit);
[[nodiscard]] std::string camera_section(const std::vector<KeyframePictures>& pictures);

/// The map from places between keyframes or of pictures held out of mapping, beside what should be seen;
/// empty where the run was not scored.
[[nodiscard]] std::string held_out_section(RunFolder& run, std::size_t limit);

/// Up to `limit` keyframes with tracking's patches on the picture, evenly spread; damaged ones are said in
/// run.missing. HTML, a figure each.
[[nodiscard]] std::vector<std::string> patch_pictures(RunFolder& run, std::size_t limit);
/// States over time, directions that the LiDAR does not see, patches of the picture, the devices' clocks.
[[nodiscard]] std::string tracking_section(const RunFolder& run,
                                           const std::vector<std::string>& patch_pictures);
/// Stage times: table of percentiles, curves over time; points and poses a second.
[[nodiscard]] std::string timing_section(const RunFolder& run);
/// LOCAL, LEAN and FULL over time with what decided it: latency, memory, bandwidth; bytes; the maps' hashes.
[[nodiscard]] std::string modes_section(const RunFolder& run, const LinkFigures& link);
/// Every counter of something lost, late, refused or dropped.
[[nodiscard]] std::string losses_section(const RunFolder& run);
/// Configuration, rig, all metrics, and what this report lacks.
[[nodiscard]] std::string settings_section(const RunFolder& run);

}  // namespace edgesplat::report
