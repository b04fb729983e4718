// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/drivers/livox/lidar_session.hpp"
#include "test/robot/livox/packet_bytes.hpp"
#include "test/support/random.hpp"
#include "tools/virtual_device/virtual_unit.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace edgesplat::livox {

/// A session and virtual units on one wire, in virtual time: 1 ms steps, seeded losses, a cable to pull.
class VirtualWire {
 public:
  static constexpr Ipv4 kHost{127, 9, 0, 1};
  static constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

  VirtualWire(LidarSession& session, std::vector<virtual_device::VirtualUnit*> units)
      : session_(session), units_(std::move(units)) {}

  /// What the host's route to the LiDAR says.
  static HostTowards host_towards() {
    return [](const Ipv4&) { return std::optional(kHost); };
  }
  [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }
  [[nodiscard]] double now_s() const { return static_cast<double>(now_ns_ - kStart_ns) * 1e-9; }
  void pull() { pulled_ = true; }
  void plug() { pulled_ = false; }
  void lose(double share) { loss_ = share; }
  /// The LiDAR's own words only, not the data: somebody else got them.
  void stop_data(bool stop) { data_stopped_ = stop; }

  void run(double seconds) {
    for (const std::int64_t end_ns = now_ns_ + static_cast<std::int64_t>(seconds * 1e9); now_ns_ < end_ns;)
      tick();
  }
  /// Runs until the event comes; seconds since the call, or -1 after `limit_s`.
  double run_until(LidarEventKind kind, double limit_s) {
    const std::size_t seen = count(kind);
    const double from_s = now_s();
    while (now_s() - from_s < limit_s) {
      tick();
      if (count(kind) > seen) return now_s() - from_s;
    }
    return -1.0;
  }
  [[nodiscard]] std::size_t count(LidarEventKind kind) const {
    return static_cast<std::size_t>(
        std::count_if(events.begin(), events.end(), [kind](const LidarEvent& e) { return e.kind == kind; }));
  }
  [[nodiscard]] std::string detail(LidarEventKind kind) const {
    for (auto at = events.rbegin(); at != events.rend(); ++at)
      if (at->kind == kind) return at->detail;
    return "no such event";
  }

  std::vector<LidarEvent> events;
  std::uint64_t points = 0;
  std::uint64_t imu_samples = 0;

 private:
  using Outgoing = virtual_device::VirtualUnit::Outgoing;

  [[nodiscard]] bool arrives() { return !pulled_ && random_.uniform(0.0, 1.0) >= loss_; }
  [[nodiscard]] HostTime host_now() const { return host_time_from_ns(now_ns_ - kStart_ns + 1'000'000'000); }

  void tick() {
    now_ns_ += 1'000'000;
    for (virtual_device::VirtualUnit* unit : units_) {
      unit->step(now_ns_);
      for (const Outgoing& one : unit->take_outgoing()) hear(*unit, one);
      measure(*unit);
    }
    if (host_now() >= next_step_) next_step_ = session_.step(host_now());
    for (const LidarSession::Outgoing& one : session_.take_outgoing()) speak(one);
    for (LidarEvent& event : session_.take_events()) events.push_back(std::move(event));
  }
  void hear(const virtual_device::VirtualUnit& unit, const Outgoing& one) {
    const LidarSessionConfig& config = session_.config();
    const bool everybody = one.to.ip == kBroadcast;
    if ((!everybody && one.to.ip != kHost) || !arrives()) return;
    const Endpoint from{unit.ip(), one.from_port};
    const bool control = one.to.port == config.control_port;
    const bool push = one.to.port == config.push_port;
    if (control || push)
      session_.on_control(control ? Channel::kControl : Channel::kPush, from, one.bytes, host_now());
    next_step_ = host_now();
  }
  void measure(virtual_device::VirtualUnit& unit) {
    const std::int64_t ms = now_ns_ / 1'000'000;
    PacketFields fields;
    fields.dots = 96;
    for (int i = 0; i < 96; ++i) append_point_mm(fields.records, 1000, 2000, i);
    fields.stamp_ns = static_cast<std::uint64_t>(now_ns_);
    arrive(unit.points(packet_bytes(fields), now_ns_), session_.config().points_port, Channel::kPoints, unit);
    if (ms % 5 != 0) return;
    fields.type = 0;
    fields.dots = 1;
    fields.records = imu_record(std::array<float, 6>{0, 0, 0, 0, 0, 1});
    arrive(unit.imu(packet_bytes(fields), now_ns_), session_.config().imu_port, Channel::kImu, unit);
  }
  void arrive(const std::optional<Outgoing>& packet, std::uint16_t port, Channel channel,
              const virtual_device::VirtualUnit& unit) {
    if (!packet || packet->to.ip != kHost || packet->to.port != port || data_stopped_ || !arrives()) return;
    if (!session_.is_from_unit(unit.ip())) return;
    ++(channel == Channel::kPoints ? points : imu_samples);
    session_.on_data(channel, host_now());
  }
  void speak(const LidarSession::Outgoing& one) {
    const virtual_device::UnitAddress from{kHost, session_.config().control_port};
    for (virtual_device::VirtualUnit* unit : units_) {
      const bool reaches = one.to.ip == kBroadcast || one.to.ip == unit->ip();
      if (reaches && arrives()) unit->on_command(one.to.port, from, one.bytes, now_ns_);
    }
  }

  LidarSession& session_;
  std::vector<virtual_device::VirtualUnit*> units_;
  test::Random random_{11};
  std::int64_t now_ns_ = kStart_ns;
  HostTime next_step_{};
  bool pulled_ = false;
  bool data_stopped_ = false;
  double loss_ = 0.0;
};

}  // namespace edgesplat::livox
