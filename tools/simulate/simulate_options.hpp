// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/rig.hpp"
#include "tools/simulate/camera_sensor.hpp"
#include "tools/simulate/device_clock.hpp"
#include "tools/simulate/lidar_pattern.hpp"
#include "tools/simulate/world.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::simulate {

/// Clean pictures of the static world from any place, e.g. to judge a map by.
struct CleanViews {
  std::filesystem::path poses;   ///< TUM, world_from_body; the rig's camera takes the picture
  std::filesystem::path folder;  ///< NNNNNN.png in the order of the file
};

enum class Lighting : std::uint8_t {
  kSteady,   ///< the exposure changes a little every 5 s
  kFailing,  ///< it changes by factors of up to six every 2 s, and the light goes out for 3 s in every 10
};

struct SimulateOptions {
  WorldConfig world;      ///< its seed decides every noise too
  double seconds = 20.0;  ///< (0, 36000]
  LidarKind lidar = LidarKind::kMid360;
  std::vector<LidarKind> more_lidars;  ///< besides the first, at most 7; see simulated_rig()
  ClockMode clock = ClockMode::kPtp;
  int camera_width_px = 320;  ///< 0 = no camera, else 32..4096
  int camera_height_px = 256;
  double camera_stamp_delay_s = 0.0;  ///< the camera's stamps come this much before mid-exposure, [-0.1, 0.1]
  double body_motion = 1.0;           ///< scale of sway and bumps, [0, 10]
  double spin_radps = 0.0;            ///< the robot turns on itself while it drives, [0, 6]
  Lighting lighting = Lighting::kSteady;
  std::filesystem::path out;  ///< the recording
  std::optional<CleanViews> clean_views;
};

/// kInvalidConfig with the option and its range.
[[nodiscard]] Status validate(const SimulateOptions& options);
/// The robot that is simulated: a LiDAR with its IMU, the camera in front above it, looking slightly down;
/// more LiDARs sit behind each other, to the left and the right in turn, and look back, tilted.
[[nodiscard]] sensor::Rig simulated_rig(const SimulateOptions& options);
/// How the simulated camera exposes; it changes its exposure every few seconds, as an automatic one does.
[[nodiscard]] CameraSensorConfig simulated_exposure(const SimulateOptions& options);
/// world.toml: what another program needs to build the same world and run again.
[[nodiscard]] std::string world_toml(const SimulateOptions& options);
/// The reverse: what world_toml() says; the camera is not in it. kInvalidConfig with the line.
[[nodiscard]] Result<SimulateOptions> parse_world_toml(std::string_view text);

}  // namespace edgesplat::simulate
