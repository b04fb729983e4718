// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/virtual_lidar.hpp"

#include "tools/simulate/livox_encoder.hpp"

namespace edgesplat::simulate {
namespace {

constexpr double kLatency_s = 150e-6;       // last point to the host's network card
constexpr double kArrivalJitter_s = 60e-6;  // mean

LidarSensorConfig lidar_config(const SimulateOptions& options) {
  LidarSensorConfig config;
  config.pattern.kind = options.lidar;
  config.body_from_lidar = simulated_rig(options).body_from_lidar;
  config.seed = options.world.seed;
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

VirtualLidar::VirtualLidar(const World& world, const Trajectory& trajectory, const SimulateOptions& options)
    : trajectory_(trajectory),
      imu_rate_hz_(imu_config(options).model.rate_hz),
      pattern_{options.lidar},
      lidar_(world, trajectory, lidar_config(options)),
      imu_(trajectory, imu_config(options)),
      clock_({.mode = options.clock}, NoisePurpose::kLidarClock, options.world.seed),
      point_arrival_(kLatency_s, kArrivalJitter_s, options.world.seed, 0),
      imu_arrival_(kLatency_s, kArrivalJitter_s, options.world.seed, 1) {}

void VirtualLidar::measure_until(double end_s, RecordingWriter& recording) {
  measure_points(end_s, recording);
  measure_inertia(end_s, recording);
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
    recording.add_points(stamp.first, point_arrival_.arrival(first + span),
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
