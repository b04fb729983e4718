// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/lidar_input.hpp"

#include "common/log/log.hpp"

#include <string>
#include <utility>

namespace edgesplat::app {
namespace {

void log_event(const livox::LidarEvent& event) {
  const livox::LidarEventName& name = livox::name_of(event.kind);
  if (name.is_problem) {
    EDGESPLAT_LOG_WARN("livox", name.words, "what", event.detail);
  } else {
    EDGESPLAT_LOG_INFO("livox", name.words, "what", event.detail);
  }
}

livox::LidarDriverConfig driver_config(const robot_config::LivoxSettings& settings, bool sees_pulses,
                                       const sensor::Rig& rig) {
  livox::LidarDriverConfig config;
  config.choice = settings.model;
  config.serial_number = settings.serial;
  config.has_imu = rig.imu.has_value();
  config.return_mode = settings.returns;
  config.feeds_utc = settings.pulse_per_second;
  config.sees_pulses = sees_pulses;
  config.transport.bind_address = settings.bind_address;
  config.transport.lidar_address = settings.address;
  config.transport.points_port = settings.points_port;
  config.transport.imu_port = settings.imu_port;
  config.transport.control_port = settings.control_port;
  config.transport.push_port = settings.push_port;
  return config;
}

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

Result<std::unique_ptr<LidarInput>> LidarInput::open(const robot_config::LivoxSettings& settings,
                                                     bool sees_pulses, const sensor::Rig& rig,
                                                     const Clock& clock, Sink sink,
                                                     replay::Recorder* recorder) {
  livox::LidarDriver::Outputs outputs{std::move(sink), log_event, {}};
  if (recorder != nullptr)
    outputs.datagram = [recorder](const livox::Datagram& datagram) { recorder->on_datagram(datagram); };
  EDGESPLAT_TRY(auto driver, livox::LidarDriver::open(driver_config(settings, sees_pulses, rig), clock,
                                                      std::move(outputs)));
  const livox::LivoxTransport& transport = driver->transport();
  EDGESPLAT_LOG_INFO("livox", "listening", "points_port", transport.points_port(), "imu_port",
                     transport.imu_port(), "receive_buffer_bytes", transport.receive_buffer_bytes());
  return std::unique_ptr<LidarInput>(new LidarInput(std::move(driver)));
}

void LidarInput::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (const Status status = driver_->step(stop); !status) {
      EDGESPLAT_LOG_ERROR("livox", "receiving failed", "why", status.error().context);
      return;
    }
  }
  driver_->stop();
}

void LidarInput::publish_counters(metrics::Registry& metrics) const {
  const livox::LivoxCounters lidar = driver_->source_counters();
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
  const livox::TransportCounters& transport = driver_->transport().counters();
  metrics.counter("livox.datagrams").add(transport.datagrams);
  metrics.counter("livox.foreign_datagrams").add(transport.foreign + driver_->foreign_data());
  metrics.counter("livox.kernel_dropped").add(transport.kernel_dropped);
  metrics.counter("livox.send_failures").add(transport.send_failures);
  const livox::LidarSessionCounters session = driver_->session_counters();
  for (std::size_t kind = 0; kind < livox::kLidarEventKinds; ++kind)
    metrics.counter(livox::name_of(static_cast<livox::LidarEventKind>(kind)).counter)
        .add(session.events.at(kind));
  metrics.counter("livox.requests").add(session.requests);
  metrics.counter("livox.request_retries").add(session.retries);
  metrics.counter("livox.bad_frames").add(session.bad_frames);
  metrics.counter("livox.utc_told").add(session.utc_told);
  metrics.gauge("livox.time_offset_ns").set(static_cast<double>(driver_->health().time_offset_ns));
}

}  // namespace edgesplat::app
