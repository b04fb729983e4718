// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/serial_imu/serial_source.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace edgesplat::serial_imu {
namespace {

InertialFrame frame(std::uint16_t sequence, std::int64_t stamp_ns) {
  return {sequence, sensor_time_from_ns(stamp_ns), {0.1F, 0.2F, 0.3F}, {0.0F, 0.0F, 9.81F}};
}

TEST(SerialSource, SamplesKeepUnitsAndStamps) {
  SerialSource source;
  const auto out = source.on_frame(frame(1, 5'000'000), host_time_from_ns(9));
  ASSERT_TRUE(out.has_value());
  const auto& sample = std::get<sensor::ImuSample>(*out);
  EXPECT_EQ(to_ns(sample.stamp), 5'000'000);
  EXPECT_EQ(to_ns(sample.arrival), 9);
  EXPECT_FLOAT_EQ(static_cast<float>(sample.gyro_radps.z()), 0.3F);
  EXPECT_FLOAT_EQ(static_cast<float>(sample.accel_mps2.z()), 9.81F);
  EXPECT_EQ(sample.stamp_source, sensor::StampSource::kFreeRunning);
}

TEST(SerialSource, HolesAreCountedOverTheWrap) {
  SerialSource source;
  (void)source.on_frame(frame(65534, 1), {});
  (void)source.on_frame(frame(2, 2), {});
  EXPECT_EQ(source.counters().lost, 3U);
}

TEST(SerialSource, NonsenseIsNotUsed) {
  SerialSource source;
  auto bad = frame(1, 1);
  bad.gyro_radps.x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(source.on_frame(bad, {}).has_value());
  bad = frame(2, 2);
  bad.accel_mps2.y() = 2000.0F;
  EXPECT_FALSE(source.on_frame(bad, {}).has_value());
  EXPECT_EQ(source.counters().bad_value, 2U);
}

TEST(SerialSource, OneStampBackIsAFaultTenAreARestart) {
  SerialSource source;
  (void)source.on_frame(frame(1, 1'000'000'000), {});
  EXPECT_FALSE(source.on_frame(frame(2, 5), {}).has_value());
  EXPECT_TRUE(source.on_frame(frame(3, 1'005'000'000), {}).has_value());
  int used = 0;
  for (std::uint16_t i = 0; i < 20; ++i) used += source.on_frame(frame(i, 100 + i), {}) ? 1 : 0;
  EXPECT_EQ(used, 11);
  EXPECT_EQ(source.counters().restarts, 1U);
}

}  // namespace
}  // namespace edgesplat::serial_imu
