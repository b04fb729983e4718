// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/virtual_lidar.hpp"

#include "tools/simulate/livox_encoder.hpp"

namespace edgesplat::simulate {
namespace {

constexpr double kLatency_s = 150e-6;       // last point to the host's network card
constexpr double kArrivalJitter_s = 60e-6;  // mean

LidarKind kind_of(const SimulateOptions& options, std::size_t unit) {
  return unit == 0 ? options.lidar : options.more_lidars.at(unit - 1);
}

/// Noise of its own for each unit; the first one's is that of a robot with one.
std::uint64_t seed_of(const SimulateOptions& options, std::size_t unit) {
  return unit == 0 ? options.world.seed : mix_bits(options.world.seed + unit);
}

LidarSensorConfig lidar_config(const SimulateOptions& options, std::size_t unit) {
  LidarSensorConfig config;
  config.pattern.kind = kind_of(options, unit);
  config.body_from_lidar = simulated_rig(options).mount_of(unit).body_from_lidar;
  config.seed = seed_of(options, unit);
  return config;
}

ImuSensorConfig imu_config(const SimulateOptions& options) {
  ImuSensorConfig config;
  config.seed = options.world.seed;
  return config;
}

HostTime true_time(std::int64_t simulation_ns) {
  return host_time_from_ns(kEpoch_ns + simulation_ns);
}

}  // namespace

VirtualLidar::VirtualLidar(const World& world, const Trajectory& trajectory, const SimulateOptions& options,
                           std::size_t unit)
    : trajectory_(trajectory),
      unit_(unit),
      imu_rate_hz_(imu_config(options).model.rate_hz),
      pattern_{kind_of(options, unit)},
      lidar_(world, trajectory, lidar_config(options, unit)),
      imu_(trajectory, imu_config(options)),
      clock_({.mode = options.clock}, NoisePurpose::kLidarClock, seed_of(options, unit)),
      point_arrival_(kLatency_s, kArrivalJitter_s, seed_of(options, unit), 0),
      imu_arrival_(kLatency_s, kArrivalJitter_s, seed_of(options, unit), 1) {}

void VirtualLidar::measure_until(double end_s, RecordingWriter& recording) {
  measure_points(end_s, recording);
  if (unit_ == 0) measure_inertia(end_s, recording);
}

void VirtualLidar::measure_points(double end_s, RecordingWriter& recording) {
  const auto whole_packets = static_cast<std::uint64_t>(from_seconds(end_s) / lidar_.packet_period());
  if (whole_packets <= next_packet_) return;
  const std::int64_t shot_ns = pattern_.shot_period_ns();
  const nanoseconds span(shot_ns * static_cast<std::int64_t>(kPointsPerPacket - 1));
  for (const LidarShots& shots : lidar_.packets(next_packet_, whole_packets - next_packet_)) {
    const HostTime first = true_time(static_cast<std::int64_t>(shots.first_shot) * shot_ns);
    const PacketStamp stamp{static_cast<std::uint16_t>(next_packet_), clock_.stamp(first), span,
                            clock_.source()};
    recording.add_points(unit_, stamp.first, point_arrival_.arrival(first + span),
                         encode_point_packet(stamp, shots.points));
    ++next_packet_;
  }
}

void VirtualLidar::measure_inertia(double end_s, RecordingWriter& recording) {
  while (static_cast<double>(next_sample_) / imu_rate_hz_ < end_s) {
    const ImuReading reading = imu_.read();
    const HostTime time = true_time(from_seconds(reading.time_s).count());
    const PacketStamp stamp{static_cast<std::uint16_t>(next_sample_), clock_.stamp(time), nanoseconds(0),
                            clock_.source()};
    constexpr double kWireGravity_mps2 = 9.80665;  // the protocol's g
    recording.add_imu(stamp.first, imu_arrival_.arrival(time),
                      encode_imu_packet(stamp, reading.gyro_radps.cast<float>(),
                                        (reading.accel_mps2 / kWireGravity_mps2).cast<float>()));
    recording.add_pose(time, trajectory_.world_from_body(reading.time_s));
    ++next_sample_;
  }
}

}  // namespace edgesplat::simulate
