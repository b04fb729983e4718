// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/metrics/registry.hpp"
#include "common/sensor/measurement.hpp"
#include "robot/config/robot_config.hpp"
#include "robot/drivers/serial_imu/serial_port.hpp"
#include "robot/drivers/serial_imu/serial_source.hpp"
#include "robot/sync/triggered_stamps.hpp"

#include <functional>
#include <stop_token>

namespace edgesplat::app {

/// The serial line: inertial samples to the sink, trigger pulses to the camera's stamps. receive() and
/// publish_counters() belong to one thread at a time.
class SerialInput {
 public:
  using Sink = std::function<void(sensor::Measurement)>;
  /// kInvalidConfig from SerialPort::create.
  static Result<SerialInput> open(const robot_config::SerialSettings& config, const Clock& clock);

  /// Until `stop` is requested. `pulses` may be null.
  void receive(const std::stop_token& stop, const Sink& sink, sync::TriggeredStamps* pulses);
  /// "serial.*".
  void publish_counters(metrics::Registry& metrics) const;

 private:
  SerialInput(const robot_config::SerialSettings& config, serial_imu::SerialPort port)
      : with_imu_(config.imu), port_(std::move(port)) {}

  bool with_imu_;
  serial_imu::SerialPort port_;
  serial_imu::FrameDecoder decoder_;
  serial_imu::SerialSource source_;
};

}  // namespace edgesplat::app
