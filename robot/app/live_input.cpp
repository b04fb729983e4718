// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/live_input.hpp"

#include "common/thread/worker.hpp"
#include "robot/app/camera_input.hpp"
#include "robot/app/lidar_input.hpp"
#include "robot/app/pps_input.hpp"
#include "robot/app/serial_input.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace edgesplat::app {
namespace {

LiveInput::Sink without_imu(const LiveInput::Sink& sink) {
  return [sink](sensor::Measurement measurement) {
    if (!std::holds_alternative<sensor::ImuSample>(measurement)) sink(std::move(measurement));
  };
}

}  // namespace

struct LiveInput::Devices {
  std::vector<std::unique_ptr<LidarInput>> lidars;
  std::optional<PpsInput> pps;
  std::optional<SerialInput> serial;
  std::unique_ptr<sync::TriggeredStamps> pulses;  ///< null: no pulses are reported
  std::unique_ptr<CameraInput> camera;            ///< null: the rig has none
  Sink sink;
  replay::Recorder* recorder;
};

LiveInput::LiveInput(std::unique_ptr<Devices> devices) : devices_(std::move(devices)) {}
LiveInput::~LiveInput() = default;

Result<std::unique_ptr<LiveInput>> LiveInput::open(const robot_config::RobotConfig& config,
                                                   const sensor::Rig& rig, const Clock& clock, Sink sink,
                                                   replay::Recorder* recorder) {
  if (config.livox.size() != rig.lidar_count())
    return fail(Errc::kInvalidConfig, "the rig has " + std::to_string(rig.lidar_count()) +
                                          " LiDARs and the configuration " +
                                          std::to_string(config.livox.size()) +
                                          ": give robot.toml a [[livox]] for each [[lidar]] of rig.toml");
  std::vector<std::unique_ptr<LidarInput>> lidars;
  for (std::size_t unit = 0; unit < config.livox.size(); ++unit) {
    // With an inertial sensor of its own the LiDAR's is not heard; of several LiDARs the first one's is.
    const Sink lidar_sink = config.serial.imu || unit > 0 ? without_imu(sink) : sink;
    EDGESPLAT_TRY(lidars.emplace_back(), LidarInput::open(config.livox, unit, !config.pps.device.empty(), rig,
                                                          clock, lidar_sink, recorder));
  }
  std::optional<PpsInput> pps;
  if (!config.pps.device.empty()) {
    EDGESPLAT_TRY(pps, PpsInput::open(config.pps, clock));
  }
  std::optional<SerialInput> serial;
  if (config.serial.imu || config.serial.trigger) {
    EDGESPLAT_TRY(serial, SerialInput::open(config.serial, clock));
  }
  std::unique_ptr<sync::TriggeredStamps> pulses;
  if (config.serial.trigger) {
    sync::TriggerMatcherConfig trigger;
    trigger.period_s = config.serial.trigger_period_s;
    pulses = std::make_unique<sync::TriggeredStamps>(trigger, 1e-6 * config.camera.gige.input_latency_us);
  }
  std::unique_ptr<CameraInput> camera;
  if (rig.camera) {
    EDGESPLAT_TRY(camera, open_camera(config.camera, *rig.camera, clock, pulses.get()));
  }
  auto devices =
      std::make_unique<Devices>(Devices{std::move(lidars), std::move(pps), std::move(serial),
                                        std::move(pulses), std::move(camera), std::move(sink), recorder});
  return std::unique_ptr<LiveInput>(new LiveInput(std::move(devices)));
}

void LiveInput::run(const std::stop_token& stop) {
  std::optional<thread::Worker> camera;
  if (devices_->camera) {
    camera.emplace(thread::Worker("camera", [this, &stop](const std::stop_token&) {
      devices_->camera->receive(stop, devices_->sink, devices_->recorder);
      return false;
    }));
  }
  std::optional<thread::Worker> serial;
  if (devices_->serial) {
    serial.emplace(thread::Worker("serial", [this, &stop](const std::stop_token&) {
      devices_->serial->receive(stop, devices_->sink, devices_->pulses.get());
      return false;
    }));
  }
  std::optional<thread::Worker> pps;
  if (devices_->pps) {
    pps.emplace(thread::Worker("pps", [this, &stop](const std::stop_token&) {
      devices_->pps->receive(stop, [this](HostTime edge, std::int64_t utc_ns) {
        for (const auto& lidar : devices_->lidars) lidar->on_pulse(edge, utc_ns);
      });
      return false;
    }));
  }
  std::vector<thread::Worker> lidars;
  for (const auto& lidar : devices_->lidars) {
    lidars.emplace_back("lidar", [&lidar, &stop](const std::stop_token&) {
      lidar->run(stop);
      return false;
    });
  }
  for (thread::Worker& lidar : lidars) lidar.join();
  if (camera) camera->join();
  if (serial) serial->join();
  if (pps) pps->join();
}

void LiveInput::publish_counters(metrics::Registry& metrics) const {
  for (const auto& lidar : devices_->lidars) lidar->publish_counters(metrics);
  if (devices_->pps) devices_->pps->publish_counters(metrics);
  if (devices_->serial) devices_->serial->publish_counters(metrics);
  if (devices_->camera) devices_->camera->publish_counters(metrics);
}

}  // namespace edgesplat::app
