// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/metrics/registry.hpp"
#include "common/sensor/rig.hpp"
#include "common/time/clock.hpp"
#include "robot/config/robot_config.hpp"
#include "robot/drivers/livox/lidar_driver.hpp"
#include "robot/drivers/replay/recorder.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

namespace edgesplat::app {

/// One of the robot's LiDARs, the first with its IMU: one line in the log for each event, everything counted.
/// Owned by one thread.
class LidarInput {
 public:
  using Sink = std::function<void(sensor::Measurement)>;

  /// Opens the sockets of `all[unit]`. Errors: those of livox::LidarDriver::open.
  /// `sees_pulses`: on_pulse() will be called.
  static Result<std::unique_ptr<LidarInput>> open(const std::vector<robot_config::LivoxSettings>& all,
                                                  std::size_t unit, bool sees_pulses, const sensor::Rig& rig,
                                                  const Clock& clock, Sink sink, replay::Recorder* recorder);
  /// Receives until `stop` is requested.
  void run(const std::stop_token& stop);
  /// See LidarDriver::on_pulse; from any thread.
  void on_pulse(HostTime edge, std::int64_t utc_ns) { driver_->on_pulse(edge, utc_ns); }
  /// Packets received, lost, refused, and the events, as "livox.*", where those of all LiDARs add up; of
  /// several also each one's, as "livox_0.*", "livox_1.*". Call after run().
  void publish_counters(metrics::Registry& metrics) const;

 private:
  LidarInput(std::unique_ptr<livox::LidarDriver> driver, std::size_t unit, bool is_alone)
      : driver_(std::move(driver)), unit_(unit), is_alone_(is_alone) {}
  void publish_as(const std::string& prefix, metrics::Registry& metrics) const;

  std::unique_ptr<livox::LidarDriver> driver_;
  std::size_t unit_;
  bool is_alone_;
};

}  // namespace edgesplat::app
