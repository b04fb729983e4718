// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/serial_input.hpp"

#include <utility>

namespace edgesplat::app {
namespace {

constexpr nanoseconds kReceiveTimeout = std::chrono::milliseconds(500);

}  // namespace

Result<SerialInput> SerialInput::open(const robot_config::SerialSettings& config, const Clock& clock) {
  EDGESPLAT_TRY(serial_imu::SerialPort port, serial_imu::SerialPort::create(config.port, clock));
  return SerialInput(config, std::move(port));
}

void SerialInput::receive(const std::stop_token& stop, const Sink& sink, sync::TriggeredStamps* pulses) {
  while (!stop.stop_requested()) {
    const auto read = port_.receive(stop, kReceiveTimeout);
    if (read.first) decoder_.restart();
    decoder_.append(read.bytes);
    while (const auto frame = decoder_.next()) {
      if (const auto* pulse = std::get_if<serial_imu::PulseFrame>(&*frame)) {
        if (pulses != nullptr)
          pulses->on_pulse({pulse->number, host_time_from_ns(pulse->edge_ns), read.arrival});
      } else if (with_imu_) {
        auto sample = source_.on_frame(std::get<serial_imu::InertialFrame>(*frame), read.arrival);
        if (sample) sink(std::move(*sample));
      }
    }
  }
}

void SerialInput::publish_counters(metrics::Registry& metrics) const {
  metrics.counter("serial.samples").add(source_.counters().samples);
  metrics.counter("serial.lost").add(source_.counters().lost);
  metrics.counter("serial.bad_value").add(source_.counters().bad_value);
  metrics.counter("serial.bad_stamp").add(source_.counters().bad_stamp);
  metrics.counter("serial.restarts").add(source_.counters().restarts);
  metrics.counter("serial.bad_checksums").add(decoder_.counters().bad_checksums);
  metrics.counter("serial.bytes_skipped").add(decoder_.counters().bytes_skipped);
  metrics.counter("serial.losses").add(port_.counters().losses);
}

}  // namespace edgesplat::app
