// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/time/time.hpp"
#include "tools/virtual_device/fault_injector.hpp"
#include "tools/virtual_device/gige_server.hpp"
#include "tools/virtual_device/lidar_device.hpp"

#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

namespace edgesplat::virtual_device {

/// What the robot finds in the camera's place.
enum class CameraKind : std::uint8_t { kFrameSocket, kGige };

struct StreamOptions {
  std::filesystem::path recording;
  std::string to = "127.0.0.1";       ///< IPv4 address of the robot
  std::uint16_t points_port = 56301;  ///< of the first LiDAR; the next ones' follow
  std::uint16_t imu_port = 56401;
  CameraKind camera = CameraKind::kFrameSocket;
  std::uint16_t frame_port = 57400;  ///< kFrameSocket: TCP, on this host; the robot connects
  GigeServerOptions gige;            ///< kGige; the model's size comes from the recording
  double gige_loss = 0.0;            ///< share of the camera's packets lost once the robot came, [0, 1]
  double speed = 1.0;                ///< (0, 100]
  double wait_for_camera_s = 10.0;   ///< for the robot to connect, [0, 3600]; then without
  FaultInjector::Rates faults;       ///< of the datagrams
  std::uint64_t seed = 1;            ///< of the faults
  /// Virtual LiDARs, one for each of the recording's; empty: datagrams as they are to `to`, nobody is
  /// answered.
  std::vector<LidarDeviceConfig> lidars;
  double wait_for_lidar_s = 20.0;  ///< for the robot to ask each virtual LiDAR to measure, [0, 3600]
};

/// What happened to everything that was in the recording.
struct StreamReport {
  std::uint64_t points_sent = 0;  ///< datagrams
  std::uint64_t imu_sent = 0;
  std::uint64_t refused = 0;  ///< by the system: buffers full, no route
  std::uint64_t flipped = 0;  ///< on demand
  std::uint64_t dropped = 0;  ///< on demand
  std::uint64_t frames_sent = 0;
  std::uint64_t frames_lost = 0;
  std::uint64_t camera_packets = 0;         ///< kGige: first sendings
  std::uint64_t camera_packets_lost = 0;    ///< kGige: on demand
  std::uint64_t camera_packets_resent = 0;  ///< kGige: on the robot's request
  std::uint64_t messages_skipped = 0;       ///< that could not be decoded
  std::uint64_t late = 0;                   ///< messages more than 5 ms behind their time
  nanoseconds most_late{};
  bool camera_connected = false;
  std::vector<LidarDeviceCounters> lidars;  ///< of virtual LiDARs
  bool lidar_asked = false;                 ///< they were asked to measure
  bool stopped = false;                     ///< ended early by request
  std::string recording_problem;            ///< empty where the recording was whole
};

/// Plays a recording as the devices would have sent it: raw Livox datagrams over UDP (or those of a virtual
/// LiDAR, once it is asked to measure), pictures over TCP or as a GigE Vision camera, each at its recorded
/// arrival time. Blocks until the end or a stop. kNotFound, kCorrupt, kIo, kInvalidConfig (also where there
/// is another number of virtual LiDARs than the recording has).
[[nodiscard]] Result<StreamReport> stream_recording(const StreamOptions& options,
                                                    const std::stop_token& stop);

}  // namespace edgesplat::virtual_device
