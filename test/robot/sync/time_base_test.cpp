// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/time_base.hpp"

#include <gtest/gtest.h>

namespace edgesplat::sync {
namespace {

using sensor::StampSource;
constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kPtpEpoch_ns = 1'700'000'000'000'000'000;

TEST(TimeBase, DisciplinedStampsPassUnchanged) {
  TimeBase base({});
  for (std::int64_t i = 0; i < 100; ++i) {
    const auto stamp = sensor_time_from_ns(kPtpEpoch_ns + i * kMs);
    EXPECT_EQ(to_ns(base.to_host(Stream::kPoints, stamp, host_time_from_ns((1 + i % 7) * kMs + i * kMs),
                                 StampSource::kPtp)),
              to_ns(stamp));
  }
  EXPECT_TRUE(base.is_exact(Stream::kPoints));
  EXPECT_EQ(base.clock_changes(), 0U);
}

TEST(TimeBase, LateDisciplinedMessagesAreNoJump) {
  TimeBase base({});
  for (std::int64_t i = 0; i < 50; ++i) {
    const std::int64_t latency_ns = i == 20 ? 5'000 * kMs : kMs;  // a message that hung for 5 s
    (void)base.to_host(Stream::kCamera, sensor_time_from_ns(kPtpEpoch_ns + i * 100 * kMs),
                       host_time_from_ns(i * 100 * kMs + latency_ns), StampSource::kPtp);
  }
  EXPECT_TRUE(base.is_exact(Stream::kCamera));
}

TEST(TimeBase, FreeCameraJoinsTheDisciplinedLidar) {
  TimeBase base({});
  for (std::int64_t i = 1; i < 3000; ++i) {
    const std::int64_t host_ns = i * kMs;
    (void)base.to_host(Stream::kPoints, sensor_time_from_ns(kPtpEpoch_ns + i * kMs),
                       host_time_from_ns(host_ns + kMs / 5), StampSource::kPtp);
    if (i % 100 != 0) continue;
    const auto t = base.to_host(Stream::kCamera, sensor_time_from_ns(42 + i * kMs),
                                host_time_from_ns(host_ns + 2 * kMs), StampSource::kFreeRunning);
    EXPECT_NEAR(static_cast<double>(to_ns(t) - (kPtpEpoch_ns + i * kMs)), 1.8e6, 1e3) << i;
  }
  EXPECT_FALSE(base.is_exact(Stream::kCamera));
}

TEST(TimeBase, WhereTheFirstLidarIsGoneAnotherTellsOfTheHostsClock) {
  // The host's clock is 100 ppm fast against PTP; the first LiDAR is pulled after 20 s, the camera is free.
  TimeBase base({}, 0.5e-3, false, 2);
  for (std::int64_t i = 10; i < 200'000; i += 10) {
    const std::int64_t host_ns = i * kMs + i * kMs / 10'000;
    for (const std::size_t unit : {0U, 1U}) {
      if (unit == 0 && i > 20'000) continue;
      const auto stamp = sensor_time_from_ns(kPtpEpoch_ns + i * kMs);
      EXPECT_EQ(to_ns(base.to_host(points_of(unit), stamp, host_time_from_ns(host_ns + kMs / 5),
                                   StampSource::kPtp)),
                to_ns(stamp));
    }
    if (i % 100 != 0) continue;
    const auto t = base.to_host(Stream::kCamera, sensor_time_from_ns(42 + i * kMs),
                                host_time_from_ns(host_ns + 2 * kMs), StampSource::kFreeRunning);
    if (i > 11'000) {
      EXPECT_NEAR(static_cast<double>(to_ns(t) - (kPtpEpoch_ns + i * kMs)), 1.8e6, 0.3e6) << i;
    }
  }
  EXPECT_EQ(base.lies(), 0U);
}

TEST(TimeBase, OneThatIsSilentForAWhileOrJoinsLaterIsNoLiar) {
  // The host's clock drifts by 50 ppm against PTP: 3 ms in the minute after which the second one joins, and
  // in the other during which it is silent.
  TimeBase base({}, 0.5e-3, false, 2);
  for (std::int64_t i = 10; i < 240'000; i += 10) {
    const auto arrival = host_time_from_ns(i * kMs + i * kMs / 20'000 + kMs / 5);
    const auto stamp = sensor_time_from_ns(kPtpEpoch_ns + i * kMs);
    (void)base.to_host(Stream::kPoints, stamp, arrival, StampSource::kPtp);
    if (i > 60'000 && (i < 120'000 || i > 180'000))
      (void)base.to_host(points_of(1), stamp, arrival, StampSource::kPtp);
  }
  EXPECT_EQ(base.lies(), 0U);
  EXPECT_TRUE(base.is_exact(Stream::kPoints));
  EXPECT_TRUE(base.is_exact(points_of(1)));
}

TEST(TimeBase, EveryLidarHasADriftOfItsOwn) {
  TimeBase base({}, 0.5e-3, false, 3);
  constexpr double kDrift_ppm[] = {40.0, -60.0, 5.0};
  for (std::int64_t i = 5; i < 20'000; i += 5) {
    for (const std::size_t unit : {0U, 1U, 2U}) {
      const auto device_ns =
          static_cast<std::int64_t>((1.0 + 1e-6 * kDrift_ppm[unit]) * static_cast<double>(i * kMs));
      const auto t =
          base.to_host(points_of(unit), sensor_time_from_ns(device_ns + 1000 * kMs * static_cast<int>(unit)),
                       host_time_from_ns(i * kMs), StampSource::kFreeRunning);
      if (i > 5000) {
        EXPECT_NEAR(static_cast<double>(to_ns(t) - i * kMs), 0.0, 2e4) << unit;
      }
    }
  }
  for (const std::size_t unit : {0U, 1U, 2U})
    EXPECT_NEAR(base.clock_state(points_of(unit))->drift_ppm, kDrift_ppm[unit], 0.5);
}

TEST(TimeBase, ImuSharesTheRelationOfThePoints) {
  TimeBase base({});
  for (std::int64_t i = 1; i < 100; ++i) {
    const auto stamp = sensor_time_from_ns(i * 5 * kMs);
    const auto point = base.to_host(Stream::kPoints, stamp, host_time_from_ns(9'000 * kMs + i * 5 * kMs),
                                    StampSource::kFreeRunning);
    const auto sample = base.to_host(Stream::kImu, stamp, host_time_from_ns(9'003 * kMs + i * 5 * kMs),
                                     StampSource::kFreeRunning);
    EXPECT_EQ(point, sample);
  }
}

TEST(TimeBase, ADeviceThatGetsDisciplinedLaterKeepsTheLine) {
  TimeBase base({});
  HostTime previous{};
  for (std::int64_t i = 1; i < 200; ++i) {
    const bool locked = i >= 100;
    const auto stamp = sensor_time_from_ns((locked ? kPtpEpoch_ns : 0) + i * kMs);
    const auto t = base.to_host(Stream::kPoints, stamp, host_time_from_ns(50 * kMs + i * kMs),
                                locked ? StampSource::kPtp : StampSource::kFreeRunning);
    if (i > 1) {
      EXPECT_EQ((t - previous).count(), kMs) << i;
    }
    previous = t;
  }
  EXPECT_EQ(base.clock_changes(), 1U);
}

TEST(TimeBase, AnImuWithItsOwnClockIsFittedByItself) {
  TimeBase base({}, 0.5e-3, true);
  for (std::int64_t i = 1; i < 400; ++i) {
    const HostTime arrival = host_time_from_ns(9'000 * kMs + i * 5 * kMs);
    (void)base.to_host(Stream::kPoints, sensor_time_from_ns(i * 5 * kMs), arrival, StampSource::kFreeRunning);
    const auto sample = base.to_host(Stream::kImu, sensor_time_from_ns(777'000 * kMs + i * 5 * kMs), arrival,
                                     StampSource::kFreeRunning);
    EXPECT_EQ(sample, arrival);
  }
}

TEST(TimeBase, UnknownArrivalsTeachNothing) {
  TimeBase base({});
  for (std::int64_t i = 0; i < 10; ++i)
    EXPECT_EQ(to_ns(base.to_host(Stream::kPoints, sensor_time_from_ns(i * 1'000 * kMs), {},
                                 StampSource::kFreeRunning)),
              i * 1'000 * kMs);
  EXPECT_EQ(base.clock_changes(), 0U);
}

}  // namespace
}  // namespace edgesplat::sync
