// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/live_input.hpp"

#include "common/thread/worker.hpp"
#include "robot/app/camera_input.hpp"
#include "robot/app/lidar_input.hpp"

#include <optional>
#include <utility>

namespace edgesplat::app {

struct LiveInput::Devices {
  std::unique_ptr<LidarInput> lidar;
  std::unique_ptr<CameraInput> camera;  ///< null: the rig has none
  Sink sink;
  replay::Recorder* recorder;
};

LiveInput::LiveInput(std::unique_ptr<Devices> devices) : devices_(std::move(devices)) {}
LiveInput::~LiveInput() = default;

Result<std::unique_ptr<LiveInput>> LiveInput::open(const robot_config::RobotConfig& config,
                                                   const sensor::Rig& rig, const Clock& clock, Sink sink,
                                                   replay::Recorder* recorder) {
  EDGESPLAT_TRY(auto lidar, LidarInput::open(config.livox, rig, clock, sink, recorder));
  std::unique_ptr<CameraInput> camera;
  if (rig.camera) {
    EDGESPLAT_TRY(camera, open_camera(config.camera, *rig.camera, clock));
  }
  auto devices =
      std::make_unique<Devices>(Devices{std::move(lidar), std::move(camera), std::move(sink), recorder});
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
  thread::Worker lidar("lidar", [this, &stop](const std::stop_token&) {
    devices_->lidar->run(stop);
    return false;
  });
  lidar.join();
  if (camera) camera->join();
}

void LiveInput::publish_counters(metrics::Registry& metrics) const {
  devices_->lidar->publish_counters(metrics);
  if (devices_->camera) devices_->camera->publish_counters(metrics);
}

}  // namespace edgesplat::app
