// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/app/map_share.hpp"
#include "robot/local_mapping/drawn_map.hpp"
#include "robot/local_mapping/local_mapper.hpp"

#include <filesystem>
#include <memory>

namespace edgesplat::app {

/// The map as the robot has it: what the server makes of its keyframes, where there is one, and what it makes
/// itself in LOCAL or without a server. Thread-safe.
class LiveMap {
 public:
  /// `lockstep`: the robot's own mapping is done within submit(), repeatably. `robot_folder`: as of MapShare.
  /// kUnavailable, kIo where the link cannot be opened; kInvalidConfig.
  static Result<std::unique_ptr<LiveMap>> create(const robot_config::RobotConfig& config, bool lockstep,
                                                 const Clock& clock,
                                                 const std::filesystem::path& robot_folder,
                                                 metrics::Registry& metrics);

  void submit(std::shared_ptr<const map::Keyframe> keyframe);
  /// A picture took so long to draw.
  void on_picture(double render_ms);
  /// What is drawn, in `map`; never null.
  [[nodiscard]] std::shared_ptr<const gaussian::GaussianCloud> snapshot() const { return drawn_.snapshot(); }
  /// The same with the correction that it was put together with.
  [[nodiscard]] local_mapping::DrawnMap::Placed placed() const { return drawn_.placed(); }
  /// snapshot() with everything that was applied and mapped, whatever the publishing pace; waits for the
  /// robot's own mapping.
  [[nodiscard]] std::shared_ptr<const gaussian::GaussianCloud> newest_snapshot();
  [[nodiscard]] geometry::RigidTransform map_from_odom() const;
  /// At the end of a run, as of MapShare.
  bool drain(nanoseconds timeout);
  void publish_counters(metrics::Registry& metrics) const;

 private:
  LiveMap() = default;
  void on_resident(ResidentNews news);

  local_mapping::DrawnMap drawn_;
  std::unique_ptr<local_mapping::LocalMapper> local_;  ///< null: switched off
  std::unique_ptr<MapShare> share_;                    ///< null: no server
};

}  // namespace edgesplat::app
