// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/device_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace edgesplat::simulate {
namespace {

HostTime at_s(double seconds) {
  return host_time_from_ns(kEpoch_ns) + from_seconds(seconds);
}

TEST(DeviceClock, PtpStampsAreMasterTimeWithinMicroseconds) {
  const DeviceClock clock({}, NoisePurpose::kLidarClock, 7);
  EXPECT_EQ(clock.source(), sensor::StampSource::kPtp);
  double square = 0.0;
  constexpr int kCount = 20000;
  for (int k = 0; k < kCount; ++k) {
    const HostTime t = at_s(0.1 * k);
    const auto error_ns = static_cast<double>(to_ns(clock.stamp(t)) - to_ns(t));
    EXPECT_LT(std::abs(error_ns), 20e3);
    square += error_ns * error_ns;
  }
  // Linear between corrections of 3 us: the mean square of the interpolation is two thirds.
  EXPECT_NEAR(std::sqrt(square / kCount), 3e3 * std::sqrt(2.0 / 3.0), 300.0);
}

TEST(DeviceClock, PtpStampsRise) {
  const DeviceClock clock({}, NoisePurpose::kLidarClock, 7);
  for (int k = 0; k < 50000; ++k) EXPECT_LT(clock.stamp(at_s(1e-4 * k)), clock.stamp(at_s(1e-4 * (k + 1))));
}

TEST(DeviceClock, FreeClockDriftsAndCountsFromPowerOn) {
  const DeviceClock clock({ClockMode::kFree}, NoisePurpose::kLidarClock, 7);
  EXPECT_EQ(clock.source(), sensor::StampSource::kFreeRunning);
  EXPECT_GT(std::abs(clock.drift_ppm()), 0.1);
  EXPECT_LE(std::abs(clock.drift_ppm()), 50.0);
  const std::int64_t start_ns = to_ns(clock.stamp(at_s(0.0)));
  EXPECT_GT(start_ns, 4'000'000'000);
  EXPECT_LT(start_ns, 106'000'000'000);
  const std::int64_t passed_ns = to_ns(clock.stamp(at_s(1000.0))) - start_ns;
  EXPECT_NEAR(static_cast<double>(passed_ns) - 1e12, clock.drift_ppm() * 1e6, 2e4);
}

TEST(DeviceClock, DevicesHaveClocksOfTheirOwn) {
  const DeviceClock lidar({ClockMode::kFree}, NoisePurpose::kLidarClock, 7);
  const DeviceClock camera({ClockMode::kFree}, NoisePurpose::kCameraClock, 7);
  EXPECT_NE(lidar.drift_ppm(), camera.drift_ppm());
}

TEST(ArrivalModel, LatencyIsTheFloorAndTheTailIsExponential) {
  ArrivalModel model(1e-3, 2e-4, 7, 0);
  double sum_s = 0.0, least_s = 1.0;
  constexpr int kCount = 20000;
  HostTime last{};
  for (int k = 0; k < kCount; ++k) {
    const HostTime sent = at_s(0.01 * k);
    const HostTime arrival = model.arrival(sent);
    EXPECT_GE(arrival, last);
    last = arrival;
    sum_s += to_seconds(arrival - sent), least_s = std::min(least_s, to_seconds(arrival - sent));
  }
  EXPECT_NEAR(sum_s / kCount, 1.2e-3, 1e-5);
  EXPECT_NEAR(least_s, 1e-3, 1e-6);
}

}  // namespace
}  // namespace edgesplat::simulate
