// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/time/clock_map.hpp"

#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace edgesplat {
namespace {

constexpr double kMinLatency_s = 0.0008;

/// A device whose clock runs `drift_ppm` fast and started at `epoch_ns`, and the network behind it.
struct Device {
  double drift_ppm = 0.0;
  std::int64_t epoch_ns = 5'000'000'000'000;
  double jitter_s = 0.001;  ///< mean of the exponential latency above the smallest

  [[nodiscard]] SensorTime stamp(double true_s) const {
    return sensor_time_from_ns(epoch_ns + std::llround(true_s * 1e9 * (1.0 + drift_ppm * 1e-6)));
  }
  void feed(ClockMap& map, test::Random& random, double from_s, double to_s, double rate_hz) const {
    for (double t = from_s; t < to_s; t += 1.0 / rate_hz)
      map.observe(stamp(t), HostTime(from_seconds(t + kMinLatency_s + random.exponential(jitter_s))));
  }
  /// How far to_host() is from true time plus the smallest latency.
  [[nodiscard]] double error_s(const ClockMap& map, double true_s) const {
    return to_seconds(map.to_host(stamp(true_s)) - HostTime(from_seconds(true_s + kMinLatency_s)));
  }
};

struct DriftCase {
  double drift_ppm;
  double rate_hz;
};
class ClockMapDrift : public testing::TestWithParam<DriftCase> {};

TEST_P(ClockMapDrift, IsWithin200MicrosecondsAfterTenSecondsAndStaysThere) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    test::Random random(seed);
    Device device;
    device.drift_ppm = GetParam().drift_ppm;
    ClockMap map;
    device.feed(map, random, 0.0, 10.0, GetParam().rate_hz);
    for (double t = 10.0; t < 40.0; t += 0.5) {
      device.feed(map, random, t, t + 0.5, GetParam().rate_hz);
      EXPECT_LT(std::abs(device.error_s(map, t + 0.5)), 200e-6) << "seed " << seed << " at " << t;
    }
    EXPECT_NEAR(map.drift_ppm(), GetParam().drift_ppm, 25.0);
    EXPECT_EQ(map.resets(), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Crystals, ClockMapDrift,
                         testing::Values(DriftCase{50.0, 200.0}, DriftCase{-50.0, 200.0},
                                         DriftCase{0.0, 200.0}, DriftCase{50.0, 2000.0},
                                         DriftCase{-50.0, 2000.0}));

TEST(ClockMap, ACrystalThatWarmsUpDoesNotUpsetTheFitWhenOldMessagesLeaveTheWindow) {
  // Drift grows, so that delay over stamp is concave and only its two ends lie on the hull: the case where
  // forgetting the oldest message changes the whole hull.
  test::Random random(3);
  ClockMap map;
  double worst_s = 0.0;
  for (double t = 0.0; t < 60.0; t += 0.005) {
    const double device_s = t + 0.5 * 1e-6 * t * t;  // 0 ppm at the start, 60 ppm at the end
    const SensorTime stamp = sensor_time_from_ns(std::llround(device_s * 1e9));
    map.observe(stamp, HostTime(from_seconds(t + kMinLatency_s + random.exponential(0.0005))));
    if (t > 2.0)
      worst_s = std::max(
          worst_s, std::abs(to_seconds(map.to_host(stamp) - HostTime(from_seconds(t + kMinLatency_s)))));
  }
  EXPECT_LT(worst_s, 200e-6);
}

TEST(ClockMap, PassesStampsUnchangedBeforeTheFirstMessage) {
  EXPECT_EQ(to_ns(ClockMap().to_host(sensor_time_from_ns(42))), 42);
  EXPECT_EQ(ClockMap().drift_ppm(), 0.0);
}

TEST(ClockMap, OneMessageFixesTheOffset) {
  ClockMap map;
  map.observe(sensor_time_from_ns(1'000), host_time_from_ns(5'000'000));
  EXPECT_EQ(to_ns(map.to_host(sensor_time_from_ns(1'500))), 5'000'500);
}

TEST(ClockMap, SynchronisedStampsAreHostTime) {
  ClockMap map = ClockMap::synchronised();
  map.observe(sensor_time_from_ns(1'000), host_time_from_ns(5'000'000));
  EXPECT_EQ(to_ns(map.to_host(sensor_time_from_ns(1'500))), 1'500);
  EXPECT_TRUE(map.is_synchronised());
}

TEST(ClockMap, StartsAgainAfterTheDevicesClockJumps) {
  test::Random random(7);
  Device device;
  ClockMap map;
  device.feed(map, random, 0.0, 12.0, 200.0);
  device.epoch_ns += 3'000'000'000;  // forward: messages seem to arrive before they were sent
  device.feed(map, random, 12.0, 14.0, 200.0);
  EXPECT_EQ(map.resets(), 1);
  EXPECT_LT(std::abs(device.error_s(map, 14.0)), 200e-6);
  device.epoch_ns -= 7'000'000'000;  // back
  device.feed(map, random, 14.0, 16.0, 200.0);
  EXPECT_EQ(map.resets(), 2);
  EXPECT_LT(std::abs(device.error_s(map, 16.0)), 200e-6);
}

TEST(ClockMap, FollowsASmallForwardStepWithoutAReset) {
  test::Random random(8);
  Device device;
  ClockMap map;
  device.feed(map, random, 0.0, 10.0, 200.0);
  device.epoch_ns += 20'000'000;  // below the threshold
  device.feed(map, random, 10.0, 13.0, 200.0);
  EXPECT_EQ(map.resets(), 0);
  EXPECT_LT(std::abs(device.error_s(map, 13.0)), 1e-3);
}

TEST(ClockMap, IgnoresReorderedAndLateMessages) {
  test::Random random(9);
  Device device;
  ClockMap map;
  device.feed(map, random, 0.0, 10.0, 200.0);
  const HostTime before = map.to_host(device.stamp(10.0));
  map.observe(device.stamp(9.98), HostTime(from_seconds(10.0)));   // reordered
  map.observe(device.stamp(10.01), HostTime(from_seconds(10.4)));  // 0.39 s late
  EXPECT_NEAR(to_seconds(map.to_host(device.stamp(10.0)) - before), 0.0, 50e-6);
  EXPECT_EQ(map.resets(), 0);
}

TEST(ClockMap, SurvivesAbsurdStamps) {
  ClockMap map;
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  for (const std::int64_t stamp :
       {kMost, kLeast, std::int64_t{0}, kLeast, kMost, std::int64_t{-1}, kMost - 1}) {
    map.observe(sensor_time_from_ns(stamp), host_time_from_ns(1));
    (void)map.to_host(sensor_time_from_ns(kLeast));
    (void)map.to_host(sensor_time_from_ns(kMost));
  }
  // Honest messages bring it back.
  for (std::int64_t i = 1; i < 1000; ++i)
    map.observe(sensor_time_from_ns(i * 10'000'000), host_time_from_ns(i * 10'000'000 + 500));
  EXPECT_NEAR(static_cast<double>(to_ns(map.to_host(sensor_time_from_ns(9'000'000'000)))), 9'000'000'500.0,
              10.0);
}

}  // namespace
}  // namespace edgesplat
