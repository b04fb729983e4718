// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "tools/virtual_device/datagram_sender.hpp"
#include "tools/virtual_device/fault_injector.hpp"
#include "tools/virtual_device/lidar_device.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace edgesplat::virtual_device {

struct StreamOptions;
struct StreamReport;

/// Where the packets of one of a recording's LiDARs go: as they are to one address, or through a virtual
/// LiDAR that wants to be found and asked. Single-owner.
class LidarOutput {
 public:
  /// Errors: those of DatagramSender::open and LidarDevice::start.
  static Result<LidarOutput> open(const StreamOptions& options, std::size_t unit, const Clock& clock);

  /// A virtual LiDAR waits until it is asked to measure; false when it was not in time.
  bool wait_for_host(std::chrono::milliseconds timeout, const std::stop_token& stop);
  /// The recording's time `first` is now.
  void begin(HostTime first);
  void points(std::span<const std::byte> datagram, HostTime recorded);
  void imu(std::span<const std::byte> datagram, HostTime recorded);
  /// Adds its figures.
  void report(StreamReport& report) const;

 private:
  LidarOutput(const StreamOptions& options, std::size_t unit, std::optional<DatagramSender> points,
              std::optional<DatagramSender> imu, std::unique_ptr<LidarDevice> device);
  void send(DatagramSender& sender, std::span<const std::byte> datagram);

  std::optional<DatagramSender> points_;  ///< where there is no device
  std::optional<DatagramSender> imu_;
  std::unique_ptr<LidarDevice> device_;
  FaultInjector faults_;
  std::vector<std::byte> scratch_;
};

}  // namespace edgesplat::virtual_device
