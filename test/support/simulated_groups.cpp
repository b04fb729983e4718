// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/support/simulated_groups.hpp"

#include "common/base/check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace edgesplat::test {
namespace {

HostTime stamp_at(double time_s) {
  return host_time_from_ns(1'000'000'000) + from_seconds(time_s);
}

sensor::Rig mid360_rig(const SimulatedDriveConfig& config) {
  sensor::Rig rig;
  rig.name = "simulated mid360";
  rig.body_from_lidar.translation_m = Eigen::Vector3d(-0.011, -0.02329, 0.04412);  // the data sheet's
  rig.lidar.bearing_sigma_rad = 0.0013;
  rig.more_lidars = config.more_lidars;
  if (config.with_imu) rig.imu = sensor::ImuModel{};
  return rig;
}

simulate::Trajectory drive(const simulate::World& world, const simulate::TrajectoryConfig& config) {
  auto trajectory = simulate::Trajectory::create(world.path(), config);
  EDGESPLAT_CHECK(trajectory.has_value(), "the test's trajectory must be valid");
  return *std::move(trajectory);
}

simulate::LidarSensorConfig lidar_config(const sensor::Rig& rig, const SimulatedDriveConfig& config,
                                         std::size_t unit) {
  simulate::LidarSensorConfig lidar;
  lidar.body_from_lidar = rig.mount_of(unit).body_from_lidar;
  lidar.noise.noisy = config.noisy;
  lidar.seed = config.seed + 1000 * unit;
  return lidar;
}

simulate::ImuSensorConfig imu_config(const SimulatedDriveConfig& config) {
  simulate::ImuSensorConfig imu;
  imu.noisy = config.noisy;
  imu.seed = config.seed;
  return imu;
}

}  // namespace

SimulatedDrive::SimulatedDrive(const simulate::World& world, const SimulatedDriveConfig& config)
    : config_(config),
      rig_(mid360_rig(config)),
      trajectory_(drive(world, config.trajectory)),
      imu_(trajectory_, imu_config(config)) {
  for (std::size_t unit = 0; unit < rig_.lidar_count(); ++unit)
    lidars_.emplace_back(world, trajectory_, lidar_config(rig_, config, unit));
  rig_.body_from_lidar = config.lidar_error * rig_.body_from_lidar;
}

simulate::BodyState SimulatedDrive::truth(HostTime stamp) const {
  return trajectory_.at(to_seconds(stamp - stamp_at(0.0)));
}

std::optional<sync::MeasureGroup> SimulatedDrive::next() {
  const double begin_s = group_ * config_.group_s;
  const double end_s = (group_ + 1) * config_.group_s;
  if (end_s > config_.trajectory.duration_s) return std::nullopt;
  ++group_;
  sync::MeasureGroup group;
  group.begin = stamp_at(begin_s);
  group.end = stamp_at(end_s);
  for (std::size_t unit = 0; unit < lidars_.size(); ++unit) add_points(group, begin_s, end_s, unit);
  std::ranges::stable_sort(group.points, std::ranges::greater(), &sync::GroupPoint::before_end_ns);
  if (config_.with_imu) add_imu(group, begin_s, end_s);
  return group;
}

void SimulatedDrive::add_points(sync::MeasureGroup& group, double begin_s, double end_s,
                                std::size_t unit) const {
  const simulate::LidarPattern pattern;
  const double packet_s = to_seconds(lidars_[unit].packet_period());
  const double error_s = config_.lidar_stamp_error_s;
  const auto first =
      static_cast<std::uint64_t>(std::ceil(std::max(0.0, begin_s - error_s) / packet_s - 1e-6));
  const auto last = static_cast<std::uint64_t>(std::ceil(std::max(0.0, end_s - error_s) / packet_s - 1e-6));
  const std::uint64_t step = config_.keep_every_packet;
  const std::size_t at_once = step == 1 && last > first ? last - first : 1;  // on all cores
  for (std::uint64_t number = first; number < last; number += step == 1 ? at_once : step) {
    for (const auto& packet : lidars_[unit].packets(number, at_once)) {
      for (std::size_t i = 0; i < packet.points.size(); ++i) {
        const simulate::WirePoint& point = packet.points[i];
        if (point.x_mm == 0 && point.y_mm == 0 && point.z_mm == 0) continue;
        const auto shot = static_cast<std::int64_t>(packet.first_shot + i);
        const HostTime fired = stamp_at(error_s) + nanoseconds(shot * pattern.shot_period_ns());
        if (fired > group.end) continue;
        group.points.push_back(
            {Eigen::Vector3f(static_cast<float>(point.x_mm), static_cast<float>(point.y_mm),
                             static_cast<float>(point.z_mm)) *
                 1e-3F,
             static_cast<float>(point.reflectivity) / 150.0F,
             static_cast<std::int32_t>((group.end - fired).count()), 0, static_cast<std::uint8_t>(unit)});
      }
    }
  }
}

void SimulatedDrive::add_imu(sync::MeasureGroup& group, double begin_s, double end_s) {
  while (readings_.empty() || readings_.back().time_s < end_s) readings_.push_back(imu_.read());
  std::size_t first = readings_.size() - 1;
  while (first > 0 && readings_[first].time_s > begin_s) --first;
  readings_.erase(readings_.begin(), readings_.begin() + static_cast<std::ptrdiff_t>(first));
  for (const auto& reading : readings_) {
    group.imu.push_back({stamp_at(reading.time_s), reading.gyro_radps, reading.accel_mps2});
  }
}

}  // namespace edgesplat::test
