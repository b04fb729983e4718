// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Stamps of simulated devices on the common line against the time at which they were really taken.
#include "robot/sync/time_base.hpp"
#include "tools/simulate/device_clock.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace edgesplat::sync {
namespace {

using sensor::StampSource;
using simulate::ClockMode;
using simulate::DeviceClock;
using simulate::NoisePurpose;

/// A LiDAR at 200 packets/s and a camera at 10 Hz whose clock is read by round trips; the host's clock began
/// 1000 s before the simulation.
class Devices {
 public:
  using ClockOf = std::function<SensorTime(HostTime)>;
  explicit Devices(std::uint64_t seed)
      : noise_(seed, NoisePurpose::kArrival, 77), lidar_arrival_(150e-6, 60e-6, seed, 0) {}

  [[nodiscard]] static HostTime true_time(double seconds) {
    return host_time_from_ns(simulate::kEpoch_ns) + from_seconds(seconds);
  }
  [[nodiscard]] static HostTime host_time(HostTime true_time) {
    return true_time - nanoseconds(simulate::kEpoch_ns) + std::chrono::seconds(1000);
  }
  void lidar(TimeBase& base, double seconds, const ClockOf& clock, StampSource source) {
    const HostTime t = true_time(seconds);
    errors(Stream::kPoints,
           base.to_host(Stream::kPoints, clock(t), host_time(lidar_arrival_.arrival(t)), source), t, base);
  }
  void camera(TimeBase& base, double seconds, const ClockOf& clock, StampSource source) {
    const HostTime t = true_time(seconds);
    const HostTime moment = host_time(t) + from_seconds(100e-6 * (2.0 * noise_.uniform() - 1.0));
    errors(Stream::kCamera, base.to_host(Stream::kCamera, clock(t), moment, source), t, base);
  }
  /// |line - truth| of a stream, us. The truth is the true time where the line is that of the disciplined
  /// clocks, else the host's.
  std::vector<double> points_us, camera_us;
  bool line_is_true_time = true;
  bool keep = true;

 private:
  void errors(Stream stream, HostTime on_line, HostTime t, const TimeBase&) {
    if (!keep) return;
    const double us = 1e6 * std::abs(to_seconds(on_line - (line_is_true_time ? t : host_time(t))));
    (stream == Stream::kPoints ? points_us : camera_us).push_back(us);
  }
  simulate::NoiseStream noise_;
  simulate::ArrivalModel lidar_arrival_;
};

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values.at(static_cast<std::size_t>(q * static_cast<double>(values.size() - 1)));
}
double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

Devices::ClockOf clock_of(ClockMode mode, NoisePurpose device, std::uint64_t seed) {
  return [clock = DeviceClock({.mode = mode}, device, seed)](HostTime t) { return clock.stamp(t); };
}

class ClockTruth : public testing::TestWithParam<std::uint64_t> {};

TEST_P(ClockTruth, DisciplinedStampsAreWithinTenMicroseconds) {
  TimeBase base({});
  Devices devices(GetParam());
  const auto lidar = clock_of(ClockMode::kPtp, NoisePurpose::kLidarClock, GetParam());
  const auto camera = clock_of(ClockMode::kPtp, NoisePurpose::kCameraClock, GetParam());
  for (int i = 0; i < 60 * 200; ++i) {
    devices.lidar(base, i / 200.0, lidar, StampSource::kPtp);
    if (i % 20 == 0) devices.camera(base, i / 200.0, camera, StampSource::kPtp);
  }
  EXPECT_LT(quantile(devices.points_us, 0.99), 10.0);
  EXPECT_LT(quantile(devices.camera_us, 0.99), 10.0);
  EXPECT_EQ(base.lies(), 0U);
  EXPECT_EQ(base.clock_changes(), 0U);
}

TEST_P(ClockTruth, FreeRunningStampsAreWithinAMillisecond) {
  TimeBase base({});
  Devices devices(GetParam());
  devices.line_is_true_time = false;
  const auto lidar = clock_of(ClockMode::kFree, NoisePurpose::kLidarClock, GetParam());
  const auto camera = clock_of(ClockMode::kFree, NoisePurpose::kCameraClock, GetParam());
  for (int i = 0; i < 60 * 200; ++i) {
    devices.keep = i > 200;
    devices.lidar(base, i / 200.0, lidar, StampSource::kFreeRunning);
    if (i % 20 == 0) devices.camera(base, i / 200.0, camera, StampSource::kFreeRunning);
  }
  EXPECT_LT(largest(devices.points_us), 1000.0);
  EXPECT_LT(largest(devices.camera_us), 1000.0);
}

TEST_P(ClockTruth, AFreeCameraBesideADisciplinedLidarIsWithinAMillisecond) {
  TimeBase base({});
  Devices devices(GetParam());
  const auto lidar = clock_of(ClockMode::kPtp, NoisePurpose::kLidarClock, GetParam());
  const auto camera = clock_of(ClockMode::kFree, NoisePurpose::kCameraClock, GetParam());
  for (int i = 0; i < 60 * 200; ++i) {
    devices.keep = i > 200;
    devices.lidar(base, i / 200.0, lidar, StampSource::kPtp);
    if (i % 20 == 0) devices.camera(base, i / 200.0, camera, StampSource::kFreeRunning);
  }
  EXPECT_LT(largest(devices.camera_us), 1000.0);
}

/// The master is gone at 20 s, the flag stays: from then on the clock runs at its crystal's rate.
Devices::ClockOf left_alone(const Devices::ClockOf& disciplined, double ppm) {
  return [=](HostTime t) {
    const double alone_s = std::max(0.0, to_seconds(t - Devices::true_time(20.0)));
    return disciplined(t) + from_seconds(1e-6 * ppm * alone_s);
  };
}

TEST_P(ClockTruth, ACameraWhoseFlagLiesIsFoundByItsDrift) {
  for (const double ppm : {-50.0, 20.0}) {
    TimeBase base({});
    Devices devices(GetParam());
    const auto lidar = clock_of(ClockMode::kPtp, NoisePurpose::kLidarClock, GetParam());
    const auto camera = left_alone(clock_of(ClockMode::kPtp, NoisePurpose::kCameraClock, GetParam()), ppm);
    double found_s = 0.0;
    for (int i = 0; i < 120 * 200; ++i) {
      devices.lidar(base, i / 200.0, lidar, StampSource::kPtp);
      if (i % 20 == 0) devices.camera(base, i / 200.0, camera, StampSource::kPtp);
      if (base.lies() > 0 && found_s == 0.0) found_s = i / 200.0;
    }
    EXPECT_EQ(base.lies(), 1U) << ppm;
    EXPECT_GT(found_s, 20.0) << ppm;
    EXPECT_LT(found_s, 20.0 + 500.0 / std::abs(ppm) + 15.0) << ppm;  // 0.5 ms at its rate
    EXPECT_FALSE(base.is_exact(Stream::kCamera)) << ppm;
    EXPECT_TRUE(base.is_exact(Stream::kPoints)) << ppm;
    EXPECT_LT(largest(devices.camera_us), 1000.0) << ppm;
  }
}

TEST_P(ClockTruth, WhatTheLiarsMessagesTakeOnTheWayIsRemembered) {
  TimeBase base({});
  const auto lidar = clock_of(ClockMode::kPtp, NoisePurpose::kLidarClock, GetParam());
  const auto camera = left_alone(clock_of(ClockMode::kPtp, NoisePurpose::kCameraClock, GetParam()), 30.0);
  simulate::ArrivalModel lidar_arrival(150e-6, 60e-6, GetParam(), 0),
      camera_arrival(0.016, 100e-6, GetParam(), 2);
  for (int i = 0; i < 120 * 200; ++i) {
    const HostTime t = Devices::true_time(i / 200.0);
    (void)base.to_host(Stream::kPoints, lidar(t), Devices::host_time(lidar_arrival.arrival(t)),
                       StampSource::kPtp);
    if (i % 20 != 0) continue;
    const HostTime on_line = base.to_host(Stream::kCamera, camera(t),
                                          Devices::host_time(camera_arrival.arrival(t)), StampSource::kPtp);
    EXPECT_LT(std::abs(to_seconds(on_line - t)), 1e-3) << i / 200.0;
  }
  EXPECT_EQ(base.lies(), 1U);
}

TEST_P(ClockTruth, ALidarWhoseFlagLiesIsFoundToo) {
  TimeBase base({});
  Devices devices(GetParam());
  const auto lidar = left_alone(clock_of(ClockMode::kPtp, NoisePurpose::kLidarClock, GetParam()), 40.0);
  const auto camera = clock_of(ClockMode::kPtp, NoisePurpose::kCameraClock, GetParam());
  for (int i = 0; i < 120 * 200; ++i) {
    devices.lidar(base, i / 200.0, lidar, StampSource::kPtp);
    if (i % 20 == 0) devices.camera(base, i / 200.0, camera, StampSource::kPtp);
  }
  EXPECT_EQ(base.lies(), 1U);
  EXPECT_FALSE(base.is_exact(Stream::kPoints));
  EXPECT_TRUE(base.is_exact(Stream::kCamera));
  EXPECT_LT(largest(devices.points_us), 1000.0);
}

TEST_P(ClockTruth, AnUndisciplinedHostIsNoLie) {
  TimeBase base({});
  const auto lidar = clock_of(ClockMode::kPtp, NoisePurpose::kLidarClock, GetParam());
  const auto camera = clock_of(ClockMode::kPtp, NoisePurpose::kCameraClock, GetParam());
  simulate::ArrivalModel arrival(150e-6, 60e-6, GetParam(), 0);
  for (int i = 0; i < 60 * 200; ++i) {
    const HostTime t = Devices::true_time(i / 200.0);
    const auto host = [&](HostTime when) {  // 80 ppm off
      const double seconds = 1.00008 * to_seconds(when - Devices::true_time(0.0));
      return host_time_from_ns(5'000'000'000) + from_seconds(seconds);
    };
    (void)base.to_host(Stream::kPoints, lidar(t), host(arrival.arrival(t)), StampSource::kPtp);
    if (i % 20 == 0) (void)base.to_host(Stream::kCamera, camera(t), host(t), StampSource::kPtp);
  }
  EXPECT_EQ(base.lies(), 0U);
  const auto state = base.clock_state(Stream::kPoints);
  ASSERT_TRUE(state.has_value());
  EXPECT_NEAR(state->drift_ppm, -80.0, 3.0);
  EXPECT_NEAR(state->jitter_s, 60e-6, 40e-6);
}

TEST_P(ClockTruth, ArrivalsThatScatterAreNoLie) {
  TimeBase base({});
  const auto lidar = clock_of(ClockMode::kPtp, NoisePurpose::kLidarClock, GetParam());
  const auto camera = clock_of(ClockMode::kPtp, NoisePurpose::kCameraClock, GetParam());
  simulate::ArrivalModel lidar_arrival(150e-6, 60e-6, GetParam(), 0),
      camera_arrival(0.02, 0.003, GetParam(), 2);
  for (int i = 0; i < 300 * 200; ++i) {
    const HostTime t = Devices::true_time(i / 200.0);
    (void)base.to_host(Stream::kPoints, lidar(t), Devices::host_time(lidar_arrival.arrival(t)),
                       StampSource::kPtp);
    if (i % 20 == 0)
      (void)base.to_host(Stream::kCamera, camera(t), Devices::host_time(camera_arrival.arrival(t)),
                         StampSource::kPtp);
  }
  EXPECT_EQ(base.lies(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ClockTruth, testing::Values(1, 2, 3, 4, 5));

}  // namespace
}  // namespace edgesplat::sync
