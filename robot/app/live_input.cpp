// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/live_input.hpp"

#include "common/log/log.hpp"
#include "common/thread/worker.hpp"
#include "robot/app/camera_input.hpp"
#include "robot/drivers/livox/livox_source.hpp"
#include "robot/drivers/livox/livox_transport.hpp"

#include <optional>
#include <string>
#include <utility>

namespace edgesplat::app {
namespace {

constexpr nanoseconds kReceiveTimeout = std::chrono::milliseconds(500);

void publish_stream(metrics::Registry& metrics, const std::string& name, const livox::StreamCounters& c) {
  metrics.counter(name + ".packets").add(c.packets);
  metrics.counter(name + ".lost").add(c.lost);
  metrics.counter(name + ".stamp_gaps").add(c.stamp_gaps);
  metrics.counter(name + ".duplicate").add(c.duplicate);
  metrics.counter(name + ".reordered").add(c.reordered);
  metrics.counter(name + ".bad_stamp").add(c.bad_stamp);
  metrics.counter(name + ".clock_changes").add(c.clock_changes);
}

}  // namespace

struct LiveInput::Devices {
  livox::LivoxTransport lidar_transport;
  std::unique_ptr<CameraInput> camera;  ///< null: the rig has none
  livox::LivoxSource lidar_source;
  Sink sink;
  replay::Recorder* recorder;

  void receive_lidar(const std::stop_token& stop);
};

void LiveInput::Devices::receive_lidar(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const auto batch = lidar_transport.receive(stop, kReceiveTimeout);
    if (!batch) {
      EDGESPLAT_LOG_ERROR("livox", "receiving failed", "why", batch.error().context);
      return;
    }
    for (const livox::Datagram& datagram : *batch) {
      if (recorder != nullptr) recorder->on_datagram(datagram);
      auto measurement = datagram.channel == livox::Channel::kPoints
                             ? lidar_source.on_points(datagram.bytes, datagram.arrival)
                             : lidar_source.on_imu(datagram.bytes, datagram.arrival);
      if (measurement) sink(std::move(*measurement));
    }
  }
}

LiveInput::LiveInput(std::unique_ptr<Devices> devices) : devices_(std::move(devices)) {}
LiveInput::~LiveInput() = default;

Result<std::unique_ptr<LiveInput>> LiveInput::open(const robot_config::RobotConfig& config,
                                                   const sensor::Rig& rig, const Clock& clock, Sink sink,
                                                   replay::Recorder* recorder) {
  livox::LivoxTransportConfig lidar;
  lidar.bind_address = config.livox.bind_address;
  lidar.points_port = config.livox.points_port;
  lidar.imu_port = config.livox.imu_port;
  EDGESPLAT_TRY(livox::LivoxTransport transport, livox::LivoxTransport::open(lidar, clock));
  std::unique_ptr<CameraInput> camera;
  if (rig.camera) {
    EDGESPLAT_TRY(camera, open_camera(config.camera, *rig.camera, clock));
  }
  EDGESPLAT_LOG_INFO("livox", "listening", "points_port", transport.points_port(), "imu_port",
                     transport.imu_port(), "receive_buffer_bytes", transport.receive_buffer_bytes());
  auto devices = std::make_unique<Devices>(
      Devices{std::move(transport), std::move(camera), livox::LivoxSource(), std::move(sink), recorder});
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
    devices_->receive_lidar(stop);
    return false;
  });
  lidar.join();
  if (camera) camera->join();
}

void LiveInput::publish_counters(metrics::Registry& metrics) const {
  const livox::LivoxCounters lidar = devices_->lidar_source.counters();
  publish_stream(metrics, "livox.points", lidar.points);
  publish_stream(metrics, "livox.imu", lidar.imu);
  metrics.counter("livox.bad_length").add(lidar.bad_length);
  metrics.counter("livox.bad_version").add(lidar.bad_version);
  metrics.counter("livox.bad_type").add(lidar.bad_type);
  metrics.counter("livox.bad_crc").add(lidar.bad_crc);
  metrics.counter("livox.bad_value").add(lidar.bad_value);
  metrics.counter("livox.no_return_points").add(lidar.dropped_points.no_return);
  metrics.counter("livox.low_confidence_points").add(lidar.dropped_points.low_confidence);
  metrics.counter("livox.points_out").add(lidar.points_out);
  const livox::TransportCounters& transport = devices_->lidar_transport.counters();
  metrics.counter("livox.datagrams").add(transport.datagrams);
  metrics.counter("livox.foreign_datagrams").add(transport.foreign);
  metrics.counter("livox.kernel_dropped").add(transport.kernel_dropped);
  if (devices_->camera) devices_->camera->publish_counters(metrics);
}

}  // namespace edgesplat::app
