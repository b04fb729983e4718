// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/gige_source.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>

namespace edgesplat::aravis {
namespace {

constexpr std::int64_t kEpoch_ns = 1'700'000'000'000'000'000;

class GigeSourceTest : public testing::Test {
 protected:
  [[nodiscard]] RawFrame frame(std::uint16_t number, std::int64_t k) const {
    RawFrame raw;
    raw.complete = true;
    raw.number = number;
    raw.stamp = sensor_time_from_ns(kEpoch_ns + k * 100'000'000);
    raw.arrival = host_time_from_ns(5'000'000'000 + k * 100'000'000);
    raw.pixel_format = 0x01080001;
    raw.width_px = 4;
    raw.height_px = 2;
    raw.pixels = pixels_;
    return raw;
  }
  [[nodiscard]] static sensor::CameraFrame camera_frame(
      const std::optional<sensor::Measurement>& measurement) {
    return std::get<sensor::CameraFrame>(measurement.value());
  }
  std::array<std::byte, 8> pixels_{};
  GigeCameraConfig config_;
};

TEST_F(GigeSourceTest, StampsAreCarriedToTheMiddleOfTheExposure) {
  const std::array<std::pair<StampReference, int>, 3> references{std::pair{StampReference::kStart, 4'000'000},
                                                                 {StampReference::kMiddle, 0},
                                                                 {StampReference::kEnd, -4'000'000}};
  for (const auto& [reference, shift_ns] : references) {
    config_.stamp_reference = reference;
    GigeSource source(config_, {4, 2});
    auto raw = frame(1, 0);
    raw.exposure_us = 8000.0;
    EXPECT_EQ(to_ns(camera_frame(source.on_frame(raw, true)).stamp), kEpoch_ns + shift_ns);
  }
}

TEST_F(GigeSourceTest, WithoutChunksTheSetExposureAndGainHold) {
  config_.exposure_us = 2000.0;
  config_.gain_db = 6.0;
  GigeSource source(config_, {4, 2});
  const auto out = camera_frame(source.on_frame(frame(1, 0), false));
  EXPECT_FLOAT_EQ(out.exposure_s, 0.002F);
  EXPECT_FLOAT_EQ(out.gain_db, 6.0F);
  EXPECT_EQ(to_ns(out.stamp), kEpoch_ns + 1'000'000);
  EXPECT_EQ(out.stamp_source, sensor::StampSource::kFreeRunning);
}

TEST_F(GigeSourceTest, NumbersGoOnOverTheWrapThatLeavesZeroOut) {
  GigeSource source(config_, {});
  EXPECT_EQ(camera_frame(source.on_frame(frame(65534, 0), true)).sequence, 1U);
  EXPECT_EQ(camera_frame(source.on_frame(frame(65535, 1), true)).sequence, 2U);
  EXPECT_EQ(camera_frame(source.on_frame(frame(1, 2), true)).sequence, 3U);
  EXPECT_EQ(camera_frame(source.on_frame(frame(4, 5), true)).sequence, 6U);
  EXPECT_EQ(source.counters().lost, 2U);
  EXPECT_EQ(source.counters().restarts, 0U);
}

TEST_F(GigeSourceTest, IncompleteFramesAreCountedNeverUsed) {
  GigeSource source(config_, {});
  (void)source.on_frame(frame(1, 0), true);
  RawFrame broken;
  broken.number = 2;
  EXPECT_FALSE(source.on_frame(broken, true).has_value());
  EXPECT_EQ(camera_frame(source.on_frame(frame(3, 2), true)).sequence, 3U);
  EXPECT_EQ(source.counters().incomplete, 1U);
  EXPECT_EQ(source.counters().lost, 1U);
  EXPECT_EQ(source.counters().frames, 2U);
}

TEST_F(GigeSourceTest, AFrameThatWasSeenOrOvertakenIsNotUsed) {
  GigeSource source(config_, {});
  (void)source.on_frame(frame(7, 0), true);
  (void)source.on_frame(frame(9, 2), true);
  EXPECT_FALSE(source.on_frame(frame(9, 2), true).has_value());
  EXPECT_FALSE(source.on_frame(frame(8, 1), true).has_value());
  EXPECT_EQ(source.counters().duplicate, 2U);
}

TEST_F(GigeSourceTest, ACameraThatCountsAnewIsBelieved) {
  GigeSource source(config_, {});
  (void)source.on_frame(frame(900, 0), true);
  EXPECT_EQ(camera_frame(source.on_frame(frame(1, 3), true)).sequence, 2U);
  EXPECT_EQ(source.counters().restarts, 1U);
  EXPECT_EQ(source.counters().lost, 0U);
}

TEST_F(GigeSourceTest, PulsesWithoutAFrameAreCounted) {
  GigeSource source(config_, {});
  const auto pulse = [&](std::uint16_t number, std::int64_t counter) {
    auto raw = frame(number, counter);
    raw.counter = counter;
    (void)source.on_frame(raw, true);
  };
  pulse(1, 10);
  pulse(2, 11);
  pulse(3, 13);  // one pulse came while the camera was busy
  pulse(6, 16);  // two frames were lost on the way: their pulses have frames
  EXPECT_EQ(source.counters().missed_pulses, 1U);
  EXPECT_EQ(source.counters().lost, 2U);
}

TEST_F(GigeSourceTest, OtherSizesAndFormatsAreRefused) {
  GigeSource source(config_, {4, 2});
  auto raw = frame(1, 0);
  raw.width_px = 2;
  EXPECT_FALSE(source.on_frame(raw, true).has_value());
  raw = frame(2, 1);
  raw.pixel_format = 0x01100003;  // Mono10
  EXPECT_FALSE(source.on_frame(raw, true).has_value());
  raw = frame(3, 2);
  raw.pixels = raw.pixels.first(7);
  EXPECT_FALSE(source.on_frame(raw, true).has_value());
  EXPECT_EQ(source.counters().wrong_size, 1U);
  EXPECT_EQ(source.counters().bad_pictures, 2U);
  EXPECT_EQ(source.counters().frames, 0U);
}

}  // namespace
}  // namespace edgesplat::aravis
