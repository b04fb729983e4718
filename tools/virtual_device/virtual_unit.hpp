// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/virtual_device/unit_clock.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace edgesplat::virtual_device {

struct UnitAddress {
  std::array<std::uint8_t, 4> ip{};
  std::uint16_t port = 0;

  bool operator==(const UnitAddress&) const = default;
};

struct VirtualUnitConfig {
  std::string serial_number = "47MVIRTUAL0001";
  std::array<std::uint8_t, 4> ip{127, 0, 0, 1};
  double boot_s = 0.2;           ///< from power to answering, [0, 60]
  double motor_s = 0.3;          ///< from being asked to measuring, [0, 60]
  bool starts_by_itself = true;  ///< measures after a restart if it did before
  UnitClockConfig clock;
};

/// What a virtual LiDAR was asked and how it went.
struct VirtualUnitCounters {
  std::uint64_t requests = 0;
  std::uint64_t bad_frames = 0;  ///< that failed its checks
  std::uint64_t refused = 0;     ///< requests answered with an error
  std::uint64_t written = 0;     ///< parameters that were changed
  std::uint64_t sessions = 0;    ///< SDK1: handshakes; SDK2: times that it began to measure
  std::uint64_t seconds_told = 0;
  std::uint64_t seconds_late = 0;  ///< told outside the window after the pulse
};

/// A virtual LiDAR without sockets: commands go in, answers and states come out, measurements get its stamps
/// and its packets' form. Its protocol is written apart from the robot's driver. Times are true ns, of any
/// epoch. Pure, single-owner.
class VirtualUnit {
 public:
  /// A datagram that goes out of one of its ports.
  struct Outgoing {
    std::uint16_t from_port = 0;
    UnitAddress to;
    std::vector<std::byte> bytes;
  };

  VirtualUnit(VirtualUnitConfig config, std::int64_t now_ns)
      : config_(std::move(config)), clock_(config_.clock, now_ns), ready_at_ns_(now_ns) {}
  virtual ~VirtualUnit() = default;
  VirtualUnit(const VirtualUnit&) = delete;
  VirtualUnit& operator=(const VirtualUnit&) = delete;

  /// A command that came to `port`.
  void on_command(std::uint16_t port, const UnitAddress& from, std::span<const std::byte> datagram,
                  std::int64_t now_ns);
  /// What it does by itself: states, announcements, its motor.
  void step(std::int64_t now_ns);
  /// A recorded Mid-360 point packet (type 1) as this unit would send it; nothing while nobody gets it.
  [[nodiscard]] virtual std::optional<Outgoing> points(std::span<const std::byte> recorded,
                                                       std::int64_t true_ns) = 0;
  [[nodiscard]] virtual std::optional<Outgoing> imu(std::span<const std::byte> recorded,
                                                    std::int64_t true_ns) = 0;
  /// Ports at which it listens for commands.
  [[nodiscard]] virtual std::vector<std::uint16_t> command_ports() const = 0;
  /// Ports from which it sends by itself.
  [[nodiscard]] virtual std::vector<std::uint16_t> sending_ports() const = 0;
  [[nodiscard]] virtual bool is_measuring(std::int64_t now_ns) const = 0;

  /// Off at once, on again after `off_ns`: its clock starts anew and it forgets what is not stored.
  void power_cycle(std::int64_t now_ns, std::int64_t off_ns);
  void move_to(const std::array<std::uint8_t, 4>& ip) { config_.ip = ip; }
  [[nodiscard]] const std::array<std::uint8_t, 4>& ip() const { return config_.ip; }
  [[nodiscard]] UnitClock& clock() { return clock_; }
  [[nodiscard]] bool is_up(std::int64_t now_ns) const { return now_ns >= ready_at_ns_; }
  [[nodiscard]] std::vector<Outgoing> take_outgoing() { return std::exchange(outgoing_, {}); }
  [[nodiscard]] const VirtualUnitCounters& counters() const { return counters_; }

 protected:
  virtual void answer(std::uint16_t port, const UnitAddress& from, std::span<const std::byte> datagram,
                      std::int64_t now_ns) = 0;
  virtual void act(std::int64_t now_ns) = 0;
  virtual void forget(std::int64_t now_ns) = 0;
  /// Whether a second told at `now_ns` comes in the window after the pulse; the clock learns it then.
  bool hear_second(std::int64_t now_ns, std::int64_t utc_ns, std::int64_t earliest_ns,
                   std::int64_t latest_ns);

  VirtualUnitConfig config_;
  UnitClock clock_;
  VirtualUnitCounters counters_;
  std::vector<Outgoing> outgoing_;

 private:
  std::int64_t ready_at_ns_;
};

/// Seconds of a config to ns.
[[nodiscard]] constexpr std::int64_t seconds_to_ns(double seconds) {
  return static_cast<std::int64_t>(seconds * 1e9);
}

}  // namespace edgesplat::virtual_device
