// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/lidar_output.hpp"

#include "tools/virtual_device/stream.hpp"

#include <utility>

namespace edgesplat::virtual_device {

Result<LidarOutput> LidarOutput::open(const StreamOptions& options, std::size_t unit, const Clock& clock) {
  if (!options.lidars.empty()) {
    EDGESPLAT_TRY(auto device, LidarDevice::start(options.lidars.at(unit), clock));
    return LidarOutput(options, unit, std::nullopt, std::nullopt, std::move(device));
  }
  const auto port = [unit](std::uint16_t first) { return static_cast<std::uint16_t>(first + unit); };
  EDGESPLAT_TRY(DatagramSender points, DatagramSender::open(options.to, port(options.points_port)));
  EDGESPLAT_TRY(DatagramSender imu, DatagramSender::open(options.to, port(options.imu_port)));
  return LidarOutput(options, unit, std::move(points), std::move(imu), nullptr);
}

LidarOutput::LidarOutput(const StreamOptions& options, std::size_t unit, std::optional<DatagramSender> points,
                         std::optional<DatagramSender> imu, std::unique_ptr<LidarDevice> device)
    : points_(std::move(points)),
      imu_(std::move(imu)),
      device_(std::move(device)),
      faults_(options.faults, options.seed + unit) {}

bool LidarOutput::wait_for_host(std::chrono::milliseconds timeout, const std::stop_token& stop) {
  return device_ == nullptr || device_->wait_for_host(timeout, stop);
}

void LidarOutput::begin(HostTime first) {
  if (device_) device_->begin(first);
}

void LidarOutput::points(std::span<const std::byte> datagram, HostTime recorded) {
  if (device_) {
    device_->points(datagram, recorded);
  } else {
    send(*points_, datagram);
  }
}

void LidarOutput::imu(std::span<const std::byte> datagram, HostTime recorded) {
  if (device_) {
    device_->imu(datagram, recorded);
  } else {
    send(*imu_, datagram);
  }
}

void LidarOutput::send(DatagramSender& sender, std::span<const std::byte> datagram) {
  scratch_.assign(datagram.begin(), datagram.end());
  if (faults_.pass(scratch_)) sender.send(scratch_);
}

void LidarOutput::report(StreamReport& report) const {
  if (device_) {
    const LidarDeviceCounters& lidar = report.lidars.emplace_back(device_->counters());
    report.points_sent += lidar.points_sent;
    report.imu_sent += lidar.imu_sent;
    report.refused += lidar.refused;
    report.dropped += lidar.lost;
    return;
  }
  report.points_sent += points_->sent();
  report.imu_sent += imu_->sent();
  report.refused += points_->refused() + imu_->refused();
  report.flipped += faults_.flipped();
  report.dropped += faults_.dropped();
}

}  // namespace edgesplat::virtual_device
