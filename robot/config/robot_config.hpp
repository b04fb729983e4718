// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/link/link_config.hpp"
#include "common/policy/offload_policy.hpp"
#include "robot/drivers/aravis/camera_config.hpp"
#include "robot/drivers/livox/lidar_driver.hpp"
#include "robot/drivers/serial_imu/serial_port.hpp"
#include "robot/keyframe/keyframe_config.hpp"
#include "robot/local_mapping/local_mapping_config.hpp"
#include "robot/map/resident_map.hpp"
#include "robot/sync/camera_offset.hpp"
#include "robot/sync/group_builder.hpp"
#include "robot/tracking/tracking_config.hpp"
#include "robot/uplink/uplink.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace edgesplat::config {
class ConfigReader;
}

namespace edgesplat::robot_config {

/// One LiDAR; of several each needs to be named by its serial number or address, and ports of its own.
struct LivoxSettings {
  livox::LidarChoice model = livox::LidarChoice::kListen;
  std::string serial;   ///< empty: the first that answers
  std::string address;  ///< empty: it is searched for
  livox::ReturnMode returns = livox::ReturnMode::kFirst;
  bool pulse_per_second = false;
  std::string bind_address = "0.0.0.0";
  std::uint16_t points_port = 56301;
  std::uint16_t imu_port = 56401;
  std::uint16_t control_port = 56101;
  std::uint16_t push_port = 56201;
};

/// What an entry begins with: every unit has ports of its own.
[[nodiscard]] inline LivoxSettings livox_defaults(std::size_t unit) {
  LivoxSettings settings;
  const auto offset = static_cast<std::uint16_t>(unit);
  settings.points_port = static_cast<std::uint16_t>(settings.points_port + offset);
  settings.imu_port = static_cast<std::uint16_t>(settings.imu_port + offset);
  settings.control_port = static_cast<std::uint16_t>(settings.control_port + offset);
  settings.push_port = static_cast<std::uint16_t>(settings.push_port + offset);
  return settings;
}

enum class CameraSource : std::uint8_t { kFrameSocket, kGige };

struct CameraSettings {
  CameraSource source = CameraSource::kFrameSocket;
  std::string host = "127.0.0.1";
  std::uint16_t port = 57400;
  aravis::GigeCameraConfig gige;
};

/// A serial line to an inertial sensor or to the microcontroller that makes trigger pulses.
struct SerialSettings {
  bool imu = false;      ///< its inertial samples instead of the LiDAR's
  bool trigger = false;  ///< its trigger pulses stamp a camera whose clock is free
  double trigger_period_s = 0.1;
  serial_imu::SerialPortConfig port;
};

/// The once-a-second pulse as this machine captures it.
struct PpsSettings {
  std::string device;  ///< "/dev/pps0"; empty: not captured
  bool on_seconds = true;
};

/// The watch over PTP on this machine (linuxptp).
struct PtpSettings {
  bool watch = false;
  std::string program = "pmc";
  double period_s = 2.0;
  double offset_limit_us = 10.0;  ///< from the master, where this machine is a slave
};

/// Of `--record`.
struct RecordSettings {
  std::uint64_t min_free_bytes = std::uint64_t{512} << 20U;
  double sync_period_s = 1.0;
};

struct RenderSettings {
  double target_hz = 5.0;  ///< pictures a second, 0 = never
};

/// Algorithm 1's defaults here: the best map, and LOCAL within 2 s of the server's death.
[[nodiscard]] inline policy::OffloadConfig always_offload() {
  policy::OffloadConfig config;
  config.setting = policy::OffloadSetting::kAlways;
  config.server_timeout_s = 1.5;  // with an evaluation every 0.5 s
  return config;
}

struct OffloadSettings {
  policy::OffloadConfig policy = always_offload();
  std::uint64_t memory_reserve_bytes = std::uint64_t{200}
                                       << 20U;  ///< less left in the machine: as if over T_M
};

/// The uplink's defaults with the budgets of link-and-offload.md.
[[nodiscard]] inline uplink::UplinkConfig budgeted_uplink() {
  uplink::UplinkConfig config;
  config.router.full_bytes_per_s = 290e3;  // of 300 kB/s
  config.router.lean_bytes_per_s = 57e3;   // of 60 kB/s
  config.full_keyframe_bytes = 120'000;
  config.lean_keyframe_bytes = 40'000;
  return config;
}

struct ServerLink {
  bool enabled = true;
  link::LinkConfig link;
  double drain_s = 5.0;  ///< at the end of a run, how long to wait for the server's answers
};

/// Everything edgesplat-robot can be told, module by module.
struct RobotConfig {
  std::vector<LivoxSettings> livox{LivoxSettings()};  ///< in the order of the rig's LiDARs; never empty
  CameraSettings camera;
  SerialSettings serial;
  PpsSettings pps;
  PtpSettings ptp;
  sync::GroupBuilderConfig sync;
  sync::CameraOffset::Config camera_offset;
  tracking::TrackingConfig tracking;
  keyframe::KeyframeConfig keyframe;
  uplink::UplinkConfig uplink = budgeted_uplink();
  OffloadSettings offload;
  map::ResidentMapConfig map;
  local_mapping::LocalMappingConfig local;
  RecordSettings record;
  RenderSettings render;
  ServerLink server;
};

void describe(config::ConfigReader& reader, RobotConfig& config);

}  // namespace edgesplat::robot_config
