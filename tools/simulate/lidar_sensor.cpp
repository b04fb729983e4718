// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/lidar_sensor.hpp"
#include "common/thread/parallel_for.hpp"

#include <cmath>

namespace edgesplat::simulate {

nanoseconds LidarSensor::packet_period() const {
  return nanoseconds(config_.pattern.shot_period_ns() * static_cast<std::int64_t>(kPointsPerPacket));
}

Shot LidarSensor::fire(std::uint64_t shot) const {
  Shot out;
  out.direction = config_.pattern.direction(shot);
  const double time_s =
      1e-9 * static_cast<double>(config_.pattern.shot_period_ns()) * static_cast<double>(shot);
  const geometry::RigidTransform world_from_lidar =
      trajectory_.world_from_body(time_s) * config_.body_from_lidar;
  const Ray ray{world_from_lidar.translation_m, world_from_lidar.rotation * out.direction, time_s};
  const auto hit = world_.cast(ray, Visibility::kEverything);
  if (!hit) return out;
  out.range_m = static_cast<float>(hit->range_m);
  out.cosine = static_cast<float>(std::abs(hit->normal.dot(ray.direction)));
  out.reflectivity = hit->reflectivity;
  return out;
}

LidarShots LidarSensor::packet(std::uint64_t number) const {
  LidarShots out;
  out.first_shot = number * kPointsPerPacket;
  std::array<double, kPointsPerPacket> ranges_m{};
  const std::size_t lines = config_.pattern.lines();
  for (std::size_t i = 0; i < kPointsPerPacket; ++i) {
    const std::uint64_t index = out.first_shot + i;
    const Shot shot = fire(index);
    ranges_m[i] = shot.range_m;
    const double neighbour_m = i >= lines ? ranges_m[i - lines] : 0.0;
    out.points[i] =
        measure(shot, neighbour_m, config_.noise, NoiseStream(config_.seed, NoisePurpose::kLidarShot, index));
  }
  return out;
}

std::vector<LidarShots> LidarSensor::packets(std::uint64_t first_packet, std::size_t count) const {
  std::vector<LidarShots> out(count);
  thread::parallel_for(std::size_t{0}, count, [&](std::size_t i) { out[i] = packet(first_packet + i); });
  return out;
}

}  // namespace edgesplat::simulate
