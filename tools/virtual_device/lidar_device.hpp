// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/base/unique_fd.hpp"
#include "common/thread/worker.hpp"
#include "common/time/clock.hpp"
#include "tools/simulate/noise.hpp"
#include "tools/virtual_device/lidar_fault.hpp"
#include "tools/virtual_device/virtual_unit.hpp"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace edgesplat::virtual_device {

enum class LidarModel : std::uint8_t { kMid360, kAvia };

struct LidarDeviceConfig {
  LidarModel model = LidarModel::kMid360;
  VirtualUnitConfig unit;
  std::vector<LidarFault> faults;
  std::uint64_t seed = 1;  ///< of lost datagrams
};

struct LidarDeviceCounters {
  std::uint64_t points_sent = 0;
  std::uint64_t imu_sent = 0;
  std::uint64_t unsent = 0;   ///< packets while it was off, was not asked to measure, or its cable was pulled
  std::uint64_t lost = 0;     ///< on demand
  std::uint64_t refused = 0;  ///< by the system: buffers full, no route
  std::uint64_t faults = 0;   ///< that have happened
  VirtualUnitCounters unit;
};

/// A virtual LiDAR on the network: its own address and ports, a thread that answers commands, faults on
/// demand. Whoever plays a recording hands it the packets; it stamps them with its own clock and sends them
/// to the host that asked. points() and imu() belong to one thread.
class LidarDevice {
 public:
  /// kIo where a port of its address is taken or the address is not this machine's.
  static Result<std::unique_ptr<LidarDevice>> start(const LidarDeviceConfig& config, const Clock& clock);
  LidarDevice(const LidarDevice&) = delete;
  LidarDevice& operator=(const LidarDevice&) = delete;
  ~LidarDevice();

  /// Until it measures and what disciplines its clock holds. False when it was not asked to in time, or a
  /// stop was requested.
  bool wait_for_host(std::chrono::milliseconds timeout, const std::stop_token& stop);
  /// The recording's time `first` is now: from here on its packets come, and faults are due.
  void begin(HostTime first);
  /// Recorded packets, as they came (SDK2, type 1 and IMU); `recorded` is when.
  void points(std::span<const std::byte> packet, HostTime recorded);
  void imu(std::span<const std::byte> packet, HostTime recorded);
  [[nodiscard]] LidarDeviceCounters counters() const;

 private:
  LidarDevice(const LidarDeviceConfig& config, const Clock& clock, std::unique_ptr<VirtualUnit> unit);
  [[nodiscard]] Status bind_ports();
  [[nodiscard]] std::int64_t now_ns() const { return to_ns(clock_.now()); }
  bool serve(const std::stop_token& stop);
  void take_commands(const std::vector<std::uint16_t>& ports, std::int64_t now);
  void apply_faults(std::int64_t now);
  void apply(const LidarFault& fault, std::int64_t now);
  [[nodiscard]] bool is_lost();
  [[nodiscard]] bool is_pulled(std::int64_t now) const { return now < pulled_until_ns_; }
  bool send(const VirtualUnit::Outgoing& datagram);
  void send_data(std::optional<VirtualUnit::Outgoing> packet, std::uint64_t& sent, std::int64_t now);
  [[nodiscard]] std::int64_t true_ns(std::span<const std::byte> packet, HostTime recorded) const;

  const Clock& clock_;
  std::vector<LidarFault> faults_;  ///< not yet due, earliest first
  mutable std::mutex mutex_;        ///< everything below
  std::condition_variable_any stepped_;
  std::unique_ptr<VirtualUnit> unit_;
  std::map<std::uint16_t, UniqueFd> sockets_;  ///< by port
  std::optional<std::int64_t> recorded_minus_now_ns_;
  std::int64_t started_ns_ = 0;  ///< playing
  std::int64_t pulled_until_ns_ = 0;
  std::int64_t lossy_until_ns_ = 0;
  double loss_ = 0.0;
  simulate::NoiseStream noise_;
  LidarDeviceCounters counters_;
  std::optional<thread::Worker> worker_;
};

}  // namespace edgesplat::virtual_device
