// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"
#include "common/metrics/registry.hpp"
#include "common/sensor/rig.hpp"
#include "robot/app/keyframe_stage.hpp"
#include "robot/config/robot_config.hpp"

#include <filesystem>

namespace edgesplat::app {

/// What a run leaves behind, in the layout of ARCHITECTURE.md ("A run folder").
class RunFolder {
 public:
  /// Creates the folder and writes rig.toml and robot.toml, so that a full disk or a wrong path shows before
  /// the run. Errors: kIo.
  static Result<RunFolder> create(const std::filesystem::path& path, const robot_config::RobotConfig& config,
                                  const sensor::Rig& rig);

  /// The resident map before the server's last answers are waited for.
  [[nodiscard]] Status write_map_at_input_end(const gaussian::GaussianCloud& cloud) const;
  /// Trajectory, pictures, maps. `cloud` is the resident map at the end.
  [[nodiscard]] Status write_results(const KeyframeStage& keyframes, const gaussian::GaussianCloud& cloud,
                                     const geometry::RigidTransform& map_from_odom) const;
  [[nodiscard]] const std::filesystem::path& robot_folder() const { return robot_folder_; }
  [[nodiscard]] Status write_metrics(const metrics::Registry& metrics) const;

 private:
  explicit RunFolder(std::filesystem::path robot_folder) : robot_folder_(std::move(robot_folder)) {}
  std::filesystem::path robot_folder_;
};

}  // namespace edgesplat::app
