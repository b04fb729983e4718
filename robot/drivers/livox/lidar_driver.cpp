// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/lidar_driver.hpp"

#include "robot/drivers/livox/sdk1_session.hpp"
#include "robot/drivers/livox/sdk2_session.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace edgesplat::livox {
namespace {

constexpr nanoseconds kLongestWait = std::chrono::milliseconds(500);

const char* clock_name(sensor::StampSource source) {
  switch (source) {
    case sensor::StampSource::kPtp:
      return "ptp";
    case sensor::StampSource::kGps:
      return "gps";
    case sensor::StampSource::kFreeRunning:
      break;
  }
  return "since it was switched on";
}

std::optional<Ipv4> to_ipv4(const std::string& text) {
  in_addr address{};
  if (::inet_pton(AF_INET, text.c_str(), &address) != 1) return std::nullopt;
  Ipv4 ip{};
  std::memcpy(ip.data(), &address, ip.size());
  return ip;
}

}  // namespace

Result<std::unique_ptr<LidarDriver>> LidarDriver::open(const LidarDriverConfig& config, const Clock& clock,
                                                       Outputs outputs) {
  LidarDriverConfig adjusted = config;
  if (config.choice != LidarChoice::kListen) adjusted.transport.control = protocol_of(config.choice);
  EDGESPLAT_TRY(LivoxTransport transport, LivoxTransport::open(adjusted.transport, clock));
  return std::unique_ptr<LidarDriver>(
      new LidarDriver(adjusted, std::move(transport), clock, std::move(outputs)));
}

LidarDriver::LidarDriver(const LidarDriverConfig& config, LivoxTransport transport, const Clock& clock,
                         Outputs outputs)
    : clock_(clock),
      outputs_(std::move(outputs)),
      transport_(std::move(transport)),
      source_(protocol_of(config.choice), {}, config.unit),
      sees_pulses_(config.sees_pulses) {
  if (config.choice == LidarChoice::kListen) return;
  LidarSessionConfig session;
  session.serial_number = config.serial_number;
  session.address = to_ipv4(config.transport.lidar_address);
  session.neighbours = config.neighbours;
  session.has_imu = config.has_imu;
  session.return_mode = config.return_mode;
  session.feeds_utc = config.feeds_utc;
  session.points_port = transport_.points_port();
  session.imu_port = transport_.imu_port();
  session.control_port = transport_.control_port();
  session.push_port = transport_.push_port();
  const auto host_towards = [this](const Ipv4& lidar) { return transport_.host_towards(lidar); };
  if (config.choice == LidarChoice::kAvia) {
    session_ = std::make_unique<Sdk1Session>(std::move(session), host_towards);
  } else {
    session_ = std::make_unique<Sdk2Session>(std::move(session), host_towards);
  }
}

Status LidarDriver::step(const std::stop_token& stop) {
  nanoseconds timeout = kLongestWait;
  if (session_) timeout = std::clamp(next_step_ - clock_.now(), nanoseconds(0), kLongestWait);
  EDGESPLAT_TRY(const auto batch, transport_.receive(stop, step_is_due_ ? nanoseconds(0) : timeout));
  const HostTime now = clock_.now();
  for (const Datagram& datagram : batch) handle(datagram, now);
  watch_clock();
  if (!session_) return {};
  tell_time();
  if (std::exchange(step_is_due_, false) || now >= next_step_) {
    next_step_ = session_->step(now);
  }
  flush_session();
  return {};
}

void LidarDriver::on_pulse(HostTime edge, std::int64_t utc_ns) {
  const std::lock_guard lock(pulse_mutex_);
  pulse_ = Pulse{edge, utc_ns};
}

/// What the session has to know of UTC before its next step.
void LidarDriver::tell_time() {
  if (!session_->config().feeds_utc) return;
  if (!sees_pulses_) {
    const ClockPair clocks = read_clocks(clock_);
    session_->utc_feed().follow_wall_clock(clocks.host, clocks.wall_ns);
    return;
  }
  std::optional<Pulse> pulse;
  {
    const std::lock_guard lock(pulse_mutex_);
    pulse = std::exchange(pulse_, std::nullopt);
  }
  if (!pulse) return;
  session_->utc_feed().on_pulse(pulse->edge, pulse->utc_ns);
  step_is_due_ = true;
}

void LidarDriver::handle(const Datagram& datagram, HostTime now) {
  const bool is_data = datagram.channel == Channel::kPoints || datagram.channel == Channel::kImu;
  if (is_data && session_ && !session_->is_from_unit(datagram.from.ip)) {
    ++foreign_data_;
    return;
  }
  if (outputs_.datagram) outputs_.datagram(datagram);
  if (!is_data) {
    session_->on_control(datagram.channel, datagram.from, datagram.bytes, now);
    step_is_due_ = true;
    return;
  }
  auto measurement = datagram.channel == Channel::kPoints
                         ? source_.on_points(datagram.bytes, datagram.arrival)
                         : source_.on_imu(datagram.bytes, datagram.arrival);
  if (!measurement) return;
  if (session_) session_->on_data(datagram.channel, now);
  outputs_.measurement(std::move(*measurement));
}

/// Points and IMU have one clock: both see it start anew, one event tells it.
void LidarDriver::watch_clock() {
  const std::uint64_t changes =
      std::max(source_.clock_changes(Channel::kPoints), source_.clock_changes(Channel::kImu));
  if (changes == clock_changes_) return;
  clock_changes_ = changes;
  ++clock_restarts_;
  outputs_.event(
      {LidarEventKind::kClockRestarted, std::string("its stamps: ") + clock_name(source_.stamp_source())});
}

void LidarDriver::flush_session() {
  for (const LidarSession::Outgoing& one : session_->take_outgoing()) transport_.send(one.to, one.bytes);
  for (const LidarEvent& event : session_->take_events()) outputs_.event(event);
}

void LidarDriver::stop() {
  if (!session_) return;
  session_->stop(clock_.now());
  flush_session();
}

LidarSessionCounters LidarDriver::session_counters() const {
  LidarSessionCounters counters = session_ ? session_->counters() : LidarSessionCounters();
  counters.events.at(static_cast<std::size_t>(LidarEventKind::kClockRestarted)) += clock_restarts_;
  return counters;
}

}  // namespace edgesplat::livox
