// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/run_folder.hpp"

#include "common/config/config_file.hpp"
#include "common/io/atomic_file.hpp"
#include "common/io/ply_gaussians.hpp"
#include "common/io/ply_points.hpp"
#include "common/sensor/rig_config.hpp"

#include <system_error>

namespace edgesplat::app {

Result<RunFolder> RunFolder::create(const std::filesystem::path& path,
                                    const robot_config::RobotConfig& config, const sensor::Rig& rig) {
  const std::filesystem::path robot_folder = path / "robot";
  std::error_code error;
  std::filesystem::create_directories(robot_folder, error);
  if (error) {
    return fail(Errc::kIo, "cannot create the run folder " + robot_folder.string() + ": " + error.message() +
                               "; choose another with --out");
  }
  EDGESPLAT_TRY_STATUS(io::write_file_atomically(path / "rig.toml", config::to_toml(rig)));
  EDGESPLAT_TRY_STATUS(io::write_file_atomically(path / "robot.toml", config::to_toml(config)));
  return RunFolder(robot_folder);
}

Status RunFolder::write_results(const KeyframeStage& keyframes, const gaussian::GaussianCloud& cloud,
                                const geometry::RigidTransform& map_from_odom) const {
  EDGESPLAT_TRY_STATUS(keyframes.log().write(robot_folder_));
  io::PointCloud points;
  points.points_m.reserve(keyframes.coloured_map().points().size());
  for (const keyframe::OdomPoint& p : keyframes.coloured_map().points()) {
    points.points_m.push_back(p.p_in_odom_m);
    points.rgb.push_back(p.rgb);
  }
  EDGESPLAT_TRY_STATUS(io::write_points_ply(robot_folder_ / "points.ply", points));
  EDGESPLAT_TRY_STATUS(io::write_gaussians_ply(robot_folder_ / "gaussians.ply", cloud));
  return keyframes.album().write(robot_folder_, cloud, map_from_odom);
}

Status RunFolder::write_map_at_input_end(const gaussian::GaussianCloud& cloud) const {
  return io::write_gaussians_ply(robot_folder_ / "gaussians_at_input_end.ply", cloud);
}

Status RunFolder::write_metrics(const metrics::Registry& metrics) const {
  return io::write_file_atomically(robot_folder_ / "metrics.json", metrics.to_json());
}

}  // namespace edgesplat::app
