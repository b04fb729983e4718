// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/live_input.hpp"

#include "common/log/log.hpp"
#include "common/thread/worker.hpp"
#include "robot/drivers/frame_socket/frame_client.hpp"
#include "robot/drivers/frame_socket/frame_source.hpp"
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
  std::optional<frame_socket::FrameClient> camera_client;
  frame_socket::FrameSource camera_source;
  livox::LivoxSource lidar_source;
  Sink sink;
  replay::Recorder* recorder;

  void receive_lidar(const std::stop_token& stop);
  void receive_camera(const std::stop_token& stop);
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

void LiveInput::Devices::receive_camera(const std::stop_token& stop) {
  bool was_connected = false;
  while (!stop.stop_requested()) {
    const auto received = camera_client->receive(stop, kReceiveTimeout);
    if (camera_client->connected() != was_connected) {
      was_connected = !was_connected;
      if (was_connected) {
        EDGESPLAT_LOG_INFO("camera", "connected");
      } else {
        EDGESPLAT_LOG_WARN("camera", "connection lost", "why", camera_client->why_not_connected());
      }
    }
    if (!received) continue;
    if (recorder != nullptr) recorder->on_frame(received->frame, received->arrival);
    auto measurement = camera_source.on_frame(received->frame, received->arrival);
    if (measurement) sink(std::move(*measurement));
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
  std::optional<frame_socket::FrameClient> client;
  frame_socket::PictureSize size;
  if (rig.camera) {
    frame_socket::FrameClientConfig camera;
    camera.host = config.camera.host;
    camera.port = config.camera.port;
    EDGESPLAT_TRY(frame_socket::FrameClient opened, frame_socket::FrameClient::create(camera, clock));
    client.emplace(std::move(opened));
    size = {rig.camera->model.width_px, rig.camera->model.height_px};
  }
  EDGESPLAT_LOG_INFO("livox", "listening", "points_port", transport.points_port(), "imu_port",
                     transport.imu_port(), "receive_buffer_bytes", transport.receive_buffer_bytes());
  auto devices = std::make_unique<Devices>(Devices{std::move(transport), std::move(client),
                                                   frame_socket::FrameSource(size), livox::LivoxSource(),
                                                   std::move(sink), recorder});
  return std::unique_ptr<LiveInput>(new LiveInput(std::move(devices)));
}

void LiveInput::run(const std::stop_token& stop) {
  std::optional<thread::Worker> camera;
  if (devices_->camera_client) {
    camera.emplace(thread::Worker("camera", [this, &stop](const std::stop_token&) {
      devices_->receive_camera(stop);
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
  if (!devices_->camera_client) return;
  const frame_socket::FrameCounters& camera = devices_->camera_source.counters();
  metrics.counter("camera.frames").add(camera.frames);
  metrics.counter("camera.lost").add(camera.lost);
  metrics.counter("camera.bad_pictures").add(camera.bad_pictures);
  metrics.counter("camera.wrong_size").add(camera.wrong_size);
  metrics.counter("camera.disconnects").add(devices_->camera_client->counters().disconnects);
  metrics.counter("camera.bad_payloads").add(devices_->camera_client->assembler_counters().bad_payloads);
}

}  // namespace edgesplat::app
