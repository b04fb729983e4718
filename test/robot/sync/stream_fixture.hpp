// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "common/sensor/rig.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

namespace edgesplat::sync {

constexpr std::int64_t kMs = 1'000'000;

inline sensor::Rig rig_with(bool imu, bool camera) {
  sensor::Rig rig;
  if (imu) rig.imu.emplace();
  if (camera) {
    rig.camera.emplace();
    rig.camera->model = {geometry::CameraKind::kPinhole, 4, 3, 4.0, 4.0, 1.5, 1.0, {}};
  }
  return rig;
}

/// A made-up robot: packets of 5 points each 5 ms, IMU at 200 Hz, images at 10 Hz. Every point has its own
/// number in x, so that a test can tell where each of them went.
struct StreamOptions {
  std::int64_t start_ns = 1'000'000 * kMs;
  std::int64_t length_ms = 2000;
  std::int64_t image_from_ms = 37;
  std::int64_t image_period_ms = 100;
  sensor::StampSource source = sensor::StampSource::kPtp;
  bool imu = true;
  bool camera = true;
};

struct Timed {
  std::int64_t arrival_ns;
  sensor::Measurement measurement;
};

inline sensor::LidarPacket packet_at(const StreamOptions& options, std::int64_t stamp_ns, int& number) {
  sensor::LidarPacket packet;
  packet.stamp = sensor_time_from_ns(stamp_ns);
  packet.stamp_source = options.source;
  packet.span = nanoseconds(4 * kMs);
  for (int i = 0; i < 5; ++i) {
    sensor::LidarPoint point;
    point.p_in_lidar_m.x() = static_cast<float>(number++);
    point.offset_ns = static_cast<std::int32_t>(i * kMs);
    packet.points.push_back(point);
  }
  return packet;
}

inline sensor::ImuSample imu_at(const StreamOptions& options, std::int64_t stamp_ns) {
  sensor::ImuSample sample;
  sample.stamp = sensor_time_from_ns(stamp_ns);
  sample.stamp_source = options.source;
  sample.accel_mps2.z() = 9.81;
  return sample;
}

inline sensor::CameraFrame frame_at(const StreamOptions& options, std::int64_t stamp_ns,
                                    std::uint32_t sequence) {
  sensor::CameraFrame frame;
  frame.stamp = sensor_time_from_ns(stamp_ns);
  frame.stamp_source = options.source;
  frame.sequence = sequence;
  frame.image = std::make_shared<const sensor::ImageRgb8>(4, 3);
  return frame;
}

/// All measurements, each stream in order, arrival = the moment it was complete.
inline std::vector<Timed> make_stream(const StreamOptions& options) {
  std::vector<Timed> all;
  int number = 0;
  std::uint32_t sequence = 0;
  for (std::int64_t ms = 0; ms < options.length_ms; ++ms) {
    const std::int64_t t = options.start_ns + ms * kMs;
    if (ms % 5 == 0) all.push_back({t + 4 * kMs, packet_at(options, t, number)});
    if (options.imu && ms % 5 == 2) all.push_back({t, imu_at(options, t)});
    if (options.camera && ms >= options.image_from_ms &&
        (ms - options.image_from_ms) % options.image_period_ms == 0)
      all.push_back({t, frame_at(options, t, sequence++)});
  }
  return all;
}

/// Delays every message by up to `most_ms`, keeps the order within each stream, and sorts by arrival.
inline void delay_randomly(std::vector<Timed>& all, std::int64_t most_ms, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::int64_t> delay_ns(0, most_ms * kMs);
  std::int64_t latest_ns[4] = {0, 0, 0, 0};
  for (Timed& timed : all) {
    std::int64_t& latest = latest_ns[timed.measurement.index()];
    latest = std::max(latest + 1, timed.arrival_ns + delay_ns(random));
    timed.arrival_ns = latest;
  }
  const auto earlier = [](const Timed& a, const Timed& b) { return a.arrival_ns < b.arrival_ns; };
  std::stable_sort(all.begin(), all.end(), earlier);
}

/// The measurement with its arrival written into it.
inline sensor::Measurement arrived(const Timed& timed) {
  sensor::Measurement measurement = timed.measurement;
  std::visit([&](auto& one) { one.arrival = host_time_from_ns(timed.arrival_ns); }, measurement);
  return measurement;
}

}  // namespace edgesplat::sync
