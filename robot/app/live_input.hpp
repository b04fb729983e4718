// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/metrics/registry.hpp"
#include "common/sensor/rig.hpp"
#include "common/time/clock.hpp"
#include "robot/config/robot_config.hpp"
#include "robot/drivers/replay/recorder.hpp"

#include <functional>
#include <memory>
#include <stop_token>

namespace edgesplat::app {

/// The robot's sensors: the LiDARs, the first with its IMU, over UDP, the camera (see CameraInput); a thread
/// each. Owned by one thread.
class LiveInput {
 public:
  using Sink = std::function<void(sensor::Measurement)>;

  /// Opens the sockets. Errors: kIo where a port is taken (names its holder), kInvalidConfig for a bad
  /// address, or where the rig has another number of LiDARs than the configuration.
  static Result<std::unique_ptr<LiveInput>> open(const robot_config::RobotConfig& config,
                                                 const sensor::Rig& rig, const Clock& clock, Sink sink,
                                                 replay::Recorder* recorder = nullptr);
  ~LiveInput();
  LiveInput(const LiveInput&) = delete;
  LiveInput& operator=(const LiveInput&) = delete;

  /// Receives until `stop` is requested; the sink is called from the capture threads.
  void run(const std::stop_token& stop);
  /// Packets and frames received, lost, refused; call after run().
  void publish_counters(metrics::Registry& metrics) const;

 private:
  struct Devices;
  explicit LiveInput(std::unique_ptr<Devices> devices);
  std::unique_ptr<Devices> devices_;
};

}  // namespace edgesplat::app
