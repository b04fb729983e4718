// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/triggered_stamps.hpp"

#include <gtest/gtest.h>

namespace edgesplat::sync {
namespace {

constexpr std::int64_t kUnix_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kPeriod_ns = 100'000'000;

/// Slot k of the trigger line: its pulse, unless it belongs to the gap code, and the frame that it makes.
struct Line {
  TriggeredStamps stamps{TriggerMatcherConfig{}, 20e-6};
  std::uint32_t number = 0;

  std::optional<sensor::CameraFrame> slot(int k, bool lose_frame = false, bool lose_report = false) {
    if (k % 41 == 7) return std::nullopt;
    const HostTime host = host_time_from_ns(9'000'000'000 + k * kPeriod_ns);
    const std::uint32_t pulse = number++;
    if (!lose_report)
      stamps.on_pulse(
          {pulse, host_time_from_ns(kUnix_ns + k * kPeriod_ns), host + std::chrono::milliseconds(2)});
    if (lose_frame) return std::nullopt;
    sensor::CameraFrame frame;
    frame.sequence = 40 + pulse;
    frame.exposure_s = 0.008F;
    // The camera's clock: 40 ppm fast, began whenever.
    frame.stamp = sensor_time_from_ns(77'000'000 + k * (kPeriod_ns + 4'000) + 4'000'000);
    frame.arrival = host + std::chrono::milliseconds(35);
    if (!stamps.stamp(frame)) return std::nullopt;
    return frame;
  }
};

TEST(TriggeredStamps, AfterTheCodeFramesHaveTheirPulsesTime) {
  Line line;
  int stamped = 0;
  for (int k = 0; k < 300; ++k) {
    const auto frame = line.slot(k, k > 100 && k % 11 == 3, k > 100 && k % 17 == 5);
    if (!frame || frame->stamp_source != sensor::StampSource::kGps) continue;
    ++stamped;
    EXPECT_EQ(to_ns(frame->stamp), kUnix_ns + k * kPeriod_ns + 20'000 + 4'000'000) << k;
  }
  EXPECT_GT(stamped, 165);
  EXPECT_EQ(line.stamps.counters().slips, 0U);
}

TEST(TriggeredStamps, BeforeTheCodeFramesPassAsTheyAre) {
  Line line;
  for (int k = 8; k < 40; ++k) {
    const auto frame = line.slot(k);
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->stamp_source, sensor::StampSource::kFreeRunning);
  }
}

TEST(TriggeredStamps, AfterwardsAFrameWithoutACertainPulseIsDropped) {
  Line line;
  for (int k = 0; k < 120; ++k) (void)line.slot(k);
  ASSERT_GT(line.stamps.counters().matched, 0U);
  EXPECT_FALSE(line.slot(121, false, true).has_value());
  EXPECT_TRUE(line.slot(122).has_value());
}

TEST(TriggeredStamps, ADisciplinedCameraNeedsNoPulses) {
  TriggeredStamps stamps(TriggerMatcherConfig{}, 0.0);
  sensor::CameraFrame frame;
  frame.stamp = sensor_time_from_ns(kUnix_ns);
  frame.stamp_source = sensor::StampSource::kPtp;
  EXPECT_TRUE(stamps.stamp(frame));
  EXPECT_EQ(to_ns(frame.stamp), kUnix_ns);
}

}  // namespace
}  // namespace edgesplat::sync
