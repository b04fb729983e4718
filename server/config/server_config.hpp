// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/config_reader.hpp"
#include "common/link/link_config.hpp"
#include "kernels/mapping/engine.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

namespace edgesplat::config {

/// The link's defaults with room for deltas to a robot that is slow or away for a while.
[[nodiscard]] inline link::LinkConfig roomy_link() {
  link::LinkConfig config;
  config.queue_messages = 1024;
  config.queue_megabytes = 256;
  return config;
}

/// How maps are grown, made better and sent.
struct OptimiseConfig {
  bool enabled = true;               ///< off: maps stay as they are seeded
  double publish_period_s = 0.25;    ///< between two times that a robot is told what changed
  double delta_bytes_per_s = 250e3;  ///< mean that a robot is sent at most
  mapping::EngineOptions engine;
};

/// What outlives the server.
struct StoreConfig {
  bool enabled = true;               ///< off: nothing is written but metrics
  std::string folder = "store";      ///< under the run folder's server/, unless it begins with /
  double save_period_s = 10.0;       ///< between two times that a robot's map is saved
  std::size_t max_megabytes = 4096;  ///< of keyframes; the oldest go first
  std::size_t queue_keyframes = 64;  ///< waiting for the disk; full: the newest are left out
};

/// Everything edgesplat-server can be told.
struct ServerConfig {
  std::string log_level = "info";  ///< trace, debug, info, warn, error, off
  std::uint16_t instance_id =
      32769;                   ///< origin of the Gaussians this server makes; no other server or robot has it
  std::size_t max_robots = 4;  ///< served at a time
  std::size_t queue_keyframes = 16;    ///< decoded and waiting; full: the robots are held back
  std::size_t delta_gaussians = 4096;  ///< most Gaussians in one delta
  double heartbeat_period_s = 0.2;
  link::LinkConfig link = roomy_link();
  OptimiseConfig optimise;
  StoreConfig store;
};

void describe(ConfigReader& reader, ServerConfig& config);

}  // namespace edgesplat::config
