// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/link/link_config.hpp"
#include "robot/keyframe/keyframe_config.hpp"
#include "robot/map/resident_map.hpp"
#include "robot/sync/group_builder.hpp"
#include "robot/tracking/tracking_config.hpp"
#include "robot/uplink/uplink.hpp"

#include <cstdint>
#include <string>

namespace edgesplat::config {
class ConfigReader;
}

namespace edgesplat::robot_config {

struct LivoxPorts {
  std::string bind_address = "0.0.0.0";
  std::uint16_t points_port = 56301;
  std::uint16_t imu_port = 56401;
};

struct CameraSocket {
  std::string host = "127.0.0.1";
  std::uint16_t port = 57400;
};

struct RenderSettings {
  double target_hz = 5.0;  ///< at most this many pictures a second, 0 = never
};

struct ServerLink {
  bool enabled = true;
  link::LinkConfig link;
  double drain_s = 5.0;  ///< at the end of a run, how long to wait for the server's answers
};

/// Everything edgesplat-robot can be told, module by module.
struct RobotConfig {
  LivoxPorts livox;
  CameraSocket camera;
  sync::GroupBuilderConfig sync;
  tracking::TrackingConfig tracking;
  keyframe::KeyframeConfig keyframe;
  uplink::UplinkConfig uplink;
  map::ResidentMapConfig map;
  RenderSettings render;
  ServerLink server;
};

void describe(config::ConfigReader& reader, RobotConfig& config);

}  // namespace edgesplat::robot_config
