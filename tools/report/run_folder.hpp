// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/ply_points.hpp"
#include "common/io/trajectory_file.hpp"
#include "tools/report/csv_table.hpp"
#include "tools/report/mode_timeline.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace edgesplat::report {

/// The pictures of one sampled keyframe; empty paths where one is not there.
struct KeyframeFiles {
  std::string number;
  std::filesystem::path image;
  std::filesystem::path overlay;
  std::filesystem::path render;
  std::filesystem::path patches;
};

/// A run folder (ARCHITECTURE.md) as far as it can be read. Missing or damaged pieces are empty and said in
/// `missing`.
struct RunFolder {
  std::filesystem::path folder;
  std::vector<io::StampedPose> trajectory;
  CsvTable groups;
  nlohmann::json robot_metrics;   ///< null where absent
  nlohmann::json server_metrics;  ///< null where absent
  nlohmann::json stream;          ///< what the simulated sensors said, live runs only
  nlohmann::json held_out;        ///< what `edgesplat score` found, null where it did not run
  ModeTimeline modes;             ///< without samples where the robot decided nothing
  std::vector<KeyframeFiles> keyframes;
  std::optional<io::PointCloud> points;
  std::string rig_toml;
  std::string robot_toml;
  std::vector<std::string> missing;
};

/// kNotFound where the folder itself is not there; everything else is said in `missing`.
[[nodiscard]] Result<RunFolder> read_run_folder(const std::filesystem::path& folder);

}  // namespace edgesplat::report
