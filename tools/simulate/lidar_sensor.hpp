// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/rigid_transform.hpp"
#include "tools/simulate/lidar_pattern.hpp"
#include "tools/simulate/lidar_returns.hpp"
#include "tools/simulate/trajectory.hpp"
#include "tools/simulate/world.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace edgesplat::simulate {

struct LidarSensorConfig {
  LidarPattern pattern;
  LidarNoiseConfig noise;
  geometry::RigidTransform body_from_lidar;
  std::uint64_t seed = 1;
};

/// The points of one packet; first shot at `first_shot` * the pattern's shot period.
struct LidarShots {
  std::uint64_t first_shot = 0;
  std::array<WirePoint, kPointsPerPacket> points;
};

/// A LiDAR on the moving body: each ray leaves at its own time from its own place. Packets are independent
/// pure functions of (seed, packet number), so they are cast on all cores and the result does not depend on
/// how many there are. Immutable, thread-safe.
class LidarSensor {
 public:
  LidarSensor(const World& world, const Trajectory& trajectory, const LidarSensorConfig& config)
      : world_(world), trajectory_(trajectory), config_(config) {}

  /// Packets first_packet .. first_packet + count, in order.
  [[nodiscard]] std::vector<LidarShots> packets(std::uint64_t first_packet, std::size_t count) const;
  [[nodiscard]] nanoseconds packet_period() const;

 private:
  [[nodiscard]] LidarShots packet(std::uint64_t number) const;
  [[nodiscard]] Shot fire(std::uint64_t shot) const;
  const World& world_;
  const Trajectory& trajectory_;
  LidarSensorConfig config_;
};

}  // namespace edgesplat::simulate
