// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/lidar_input.hpp"

#include "common/log/log.hpp"

#include <string>
#include <utility>

namespace edgesplat::app {
namespace {

/// `who`: which of several, else empty.
void log_event(const livox::LidarEvent& event, const std::string& who) {
  const livox::LidarEventName& name = livox::name_of(event.kind);
  const std::string what = who + event.detail;
  if (name.is_problem) {
    EDGESPLAT_LOG_WARN("livox", name.words, "what", what);
  } else {
    EDGESPLAT_LOG_INFO("livox", name.words, "what", what);
  }
}

livox::LidarDriverConfig driver_config(const std::vector<robot_config::LivoxSettings>& all, std::size_t unit,
                                       bool sees_pulses, const sensor::Rig& rig) {
  const robot_config::LivoxSettings& settings = all[unit];
  livox::LidarDriverConfig config;
  config.unit = static_cast<std::uint8_t>(unit);
  for (const robot_config::LivoxSettings& other : all) {
    if (&other == &settings) continue;
    for (const std::string& name : {other.serial, other.address})
      if (!name.empty()) config.neighbours.push_back(name);
  }
  config.choice = settings.model;
  config.serial_number = settings.serial;
  config.has_imu = unit == 0 && rig.imu.has_value();
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

Result<std::unique_ptr<LidarInput>> LidarInput::open(const std::vector<robot_config::LivoxSettings>& all,
                                                     std::size_t unit, bool sees_pulses,
                                                     const sensor::Rig& rig, const Clock& clock, Sink sink,
                                                     replay::Recorder* recorder) {
  const bool is_alone = all.size() == 1;
  const std::string who = is_alone ? "" : "LiDAR " + std::to_string(unit) + ": ";
  livox::LidarDriver::Outputs outputs{
      std::move(sink), [who](const auto& event) { log_event(event, who); }, {}};
  if (recorder != nullptr)
    outputs.datagram = [recorder, unit](const livox::Datagram& datagram) {
      recorder->on_datagram(datagram, unit);
    };
  EDGESPLAT_TRY(auto driver, livox::LidarDriver::open(driver_config(all, unit, sees_pulses, rig), clock,
                                                      std::move(outputs)));
  const livox::LivoxTransport& transport = driver->transport();
  EDGESPLAT_LOG_INFO("livox", "listening", "unit", unit, "points_port", transport.points_port(), "imu_port",
                     transport.imu_port(), "receive_buffer_bytes", transport.receive_buffer_bytes());
  return std::unique_ptr<LidarInput>(new LidarInput(std::move(driver), unit, is_alone));
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
  publish_as("livox", metrics);
  if (!is_alone_) publish_as("livox_" + std::to_string(unit_), metrics);
}

void LidarInput::publish_as(const std::string& prefix, metrics::Registry& metrics) const {
  const livox::LivoxCounters lidar = driver_->source_counters();
  publish_stream(metrics, prefix + ".points", lidar.points);
  publish_stream(metrics, prefix + ".imu", lidar.imu);
  metrics.counter(prefix + ".bad_length").add(lidar.bad_length);
  metrics.counter(prefix + ".bad_version").add(lidar.bad_version);
  metrics.counter(prefix + ".bad_type").add(lidar.bad_type);
  metrics.counter(prefix + ".bad_crc").add(lidar.bad_crc);
  metrics.counter(prefix + ".bad_value").add(lidar.bad_value);
  metrics.counter(prefix + ".no_return_points").add(lidar.dropped_points.no_return);
  metrics.counter(prefix + ".low_confidence_points").add(lidar.dropped_points.low_confidence);
  metrics.counter(prefix + ".points_out").add(lidar.points_out);
  const livox::TransportCounters& transport = driver_->transport().counters();
  metrics.counter(prefix + ".datagrams").add(transport.datagrams);
  metrics.counter(prefix + ".foreign_datagrams").add(transport.foreign + driver_->foreign_data());
  metrics.counter(prefix + ".kernel_dropped").add(transport.kernel_dropped);
  metrics.counter(prefix + ".send_failures").add(transport.send_failures);
  const livox::LidarSessionCounters session = driver_->session_counters();
  for (std::size_t kind = 0; kind < livox::kLidarEventKinds; ++kind)
    metrics.counter(prefix + "." + livox::name_of(static_cast<livox::LidarEventKind>(kind)).counter)
        .add(session.events.at(kind));
  metrics.counter(prefix + ".requests").add(session.requests);
  metrics.counter(prefix + ".request_retries").add(session.retries);
  metrics.counter(prefix + ".bad_frames").add(session.bad_frames);
  metrics.counter(prefix + ".utc_told").add(session.utc_told);
  // Not a sum: of the first.
  if (unit_ == 0 || prefix != "livox")
    metrics.gauge(prefix + ".time_offset_ns").set(static_cast<double>(driver_->health().time_offset_ns));
}

}  // namespace edgesplat::app
