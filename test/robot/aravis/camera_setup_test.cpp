// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/camera_setup.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace edgesplat::aravis {
namespace {

/// A camera that is a list of names; notes each write.
class ListedCamera final : public FeatureAccess {
 public:
  std::set<std::string, std::less<>> features;
  std::map<std::string, std::vector<std::string>, std::less<>> entries;
  std::set<std::string, std::less<>> refuses;
  std::vector<std::string> writes;

  [[nodiscard]] bool has(std::string_view name) const override { return features.contains(name); }
  [[nodiscard]] std::vector<std::string> choices(std::string_view name) const override {
    const auto found = entries.find(name);
    return found == entries.end() ? std::vector<std::string>{} : found->second;
  }
  Status set(std::string_view name, bool value) override { return note(name, value ? "true" : "false"); }
  Status set(std::string_view name, std::int64_t value) override { return note(name, std::to_string(value)); }
  Status set(std::string_view name, double value) override {
    return note(name, std::to_string(std::lround(value)));
  }
  Status choose(std::string_view name, std::string_view entry) override { return note(name, entry); }
  Status execute(std::string_view name) override { return note(name, "!"); }
  Result<std::int64_t> integer(std::string_view name) override {
    if (!has(name)) return fail(Errc::kNotFound, std::string(name));
    return 1234;
  }
  Result<double> number(std::string_view) override { return 0.0; }
  Result<std::string> chosen(std::string_view) override { return std::string("Slave"); }

  [[nodiscard]] std::ptrdiff_t place(std::string_view write) const {
    const auto found = std::ranges::find(writes, write);
    EXPECT_NE(found, writes.end()) << write;
    return found - writes.begin();
  }

 private:
  Status note(std::string_view name, std::string_view value) {
    if (!has(name)) return fail(Errc::kNotFound, std::string(name) + " is not there");
    if (refuses.contains(name)) return fail(Errc::kUnavailable, std::string(name) + " is refused");
    writes.push_back(std::string(name) + "=" + std::string(value));
    return {};
  }
};

ListedCamera modern_camera() {
  ListedCamera camera;
  camera.features = {"PtpEnable",
                     "PtpDataSetLatch",
                     "PtpStatus",
                     "PtpOffsetFromMaster",
                     "TimestampLatch",
                     "TimestampLatchValue",
                     "PixelFormat",
                     "AcquisitionMode",
                     "AcquisitionFrameRateEnable",
                     "AcquisitionFrameRate",
                     "TriggerSelector",
                     "TriggerMode",
                     "TriggerSource",
                     "TriggerActivation",
                     "TriggerDelay",
                     "ExposureAuto",
                     "ExposureTime",
                     "GainAuto",
                     "Gain",
                     "ChunkModeActive",
                     "ChunkSelector",
                     "ChunkEnable"};
  camera.entries["TriggerSelector"] = {"AcquisitionStart", "FrameStart", "LineStart"};
  camera.entries["ChunkSelector"] = {"Timestamp", "ExposureTime", "Gain", "FrameID", "CounterValue", "Image"};
  return camera;
}

using testing::Contains;
using testing::IsEmpty;
using testing::Not;

TEST(CameraSetup, StandardNamesInTheOrderThatCamerasWant) {
  ListedCamera camera = modern_camera();
  const auto abilities = set_up_camera(camera, {});
  ASSERT_TRUE(abilities.has_value());
  EXPECT_THAT(abilities->without, IsEmpty());
  EXPECT_LT(camera.place("PtpEnable=true"), camera.place("PixelFormat=BayerRG8"));
  EXPECT_LT(camera.place("PixelFormat=BayerRG8"), camera.place("TriggerMode=On"));
  EXPECT_LT(camera.place("TriggerSource=Line0"), camera.place("TriggerMode=On"));
  EXPECT_LT(camera.place("ExposureAuto=Off"), camera.place("ExposureTime=5000"));
  EXPECT_LT(camera.place("ChunkModeActive=true"), camera.place("ChunkEnable=true"));
  EXPECT_EQ(abilities->chunks.size(), 5U);
  EXPECT_EQ(abilities->ptp_status, "PtpStatus");
  EXPECT_THAT(camera.writes, Not(Contains("ChunkSelector=Image")));
}

TEST(CameraSetup, EveryOtherTriggerIsTurnedOff) {
  ListedCamera camera = modern_camera();
  ASSERT_TRUE(set_up_camera(camera, {}).has_value());
  for (const char* other : {"TriggerSelector=AcquisitionStart", "TriggerSelector=LineStart"})
    EXPECT_EQ(camera.writes.at(static_cast<std::size_t>(camera.place(other)) + 1), "TriggerMode=Off")
        << other;
  const auto on = static_cast<std::size_t>(camera.place("TriggerMode=On"));
  std::size_t selected = 0;
  for (std::size_t i = 0; i < on; ++i)
    if (camera.writes[i].starts_with("TriggerSelector=")) selected = i;
  EXPECT_EQ(camera.writes[selected], "TriggerSelector=FrameStart");
}

TEST(CameraSetup, NamesOfOlderCameras) {
  ListedCamera camera;
  camera.features = {"GevIEEE1588",
                     "GevIEEE1588DataSetLatch",
                     "GevIEEE1588StatusLatched",
                     "GevIEEE1588OffsetFromMaster",
                     "GevIEEE1588SlaveOnly",
                     "GevTimestampControlLatch",
                     "GevTimestampValue",
                     "PixelFormat",
                     "TriggerMode",
                     "TriggerSource",
                     "ExposureTimeAbs",
                     "GainRaw",
                     "AcquisitionFrameRateAbs"};
  GigeCameraConfig config;
  config.gain_db = 2.5;
  const auto abilities = set_up_camera(camera, config);
  ASSERT_TRUE(abilities.has_value());
  EXPECT_THAT(camera.writes, Contains("GevIEEE1588=true"));
  EXPECT_THAT(camera.writes, Contains("GevIEEE1588SlaveOnly=true"));
  EXPECT_THAT(camera.writes, Contains("ExposureTimeAbs=5000"));
  EXPECT_THAT(camera.writes, Contains("GainRaw=25"));
  EXPECT_EQ(abilities->ptp_status, "GevIEEE1588StatusLatched");
  EXPECT_EQ(abilities->clock_latch, "GevTimestampControlLatch");
  const auto ptp = read_ptp(camera, *abilities);
  ASSERT_TRUE(ptp.has_value());
  EXPECT_TRUE(ptp->is_slave());
  EXPECT_EQ(ptp->offset_ns, 1234);
  EXPECT_EQ(read_clock_ticks(camera, *abilities).value(), 1234);
}

TEST(CameraSetup, ModeInsteadOfASwitch) {
  ListedCamera camera = modern_camera();
  camera.features.erase("PtpEnable");
  camera.features.insert("PtpMode");
  ASSERT_TRUE(set_up_camera(camera, {}).has_value());
  EXPECT_THAT(camera.writes, Contains("PtpMode=Slave"));
}

TEST(CameraSetup, ACameraWithoutPtpWorksAndSaysSo) {
  ListedCamera camera = modern_camera();
  for (const char* name : {"PtpEnable", "PtpDataSetLatch", "PtpStatus", "PtpOffsetFromMaster"})
    camera.features.erase(name);
  const auto abilities = set_up_camera(camera, {});
  ASSERT_TRUE(abilities.has_value());
  EXPECT_FALSE(abilities->has_ptp());
  ASSERT_EQ(abilities->without.size(), 1U);
}

TEST(CameraSetup, ARefusedWishIsNotedAndARefusedNeedIsAnError) {
  ListedCamera wish = modern_camera();
  wish.refuses = {"GainAuto", "TriggerDelay"};
  const auto abilities = set_up_camera(wish, {});
  ASSERT_TRUE(abilities.has_value());
  EXPECT_EQ(abilities->without.size(), 2U);
  for (const char* need : {"PixelFormat", "TriggerSource", "TriggerMode", "ExposureTime"}) {
    ListedCamera camera = modern_camera();
    camera.refuses = {need};
    EXPECT_FALSE(set_up_camera(camera, {}).has_value()) << need;
  }
}

TEST(CameraSetup, FreeRunningTurnsTheTriggersOffAndSetsTheRate) {
  ListedCamera camera = modern_camera();
  GigeCameraConfig config;
  config.trigger = Trigger::kFree;
  config.frame_rate_hz = 20.0;
  config.exposure_us = 0.0;
  config.gain_db = -1.0;
  ASSERT_TRUE(set_up_camera(camera, config).has_value());
  EXPECT_THAT(camera.writes, Not(Contains("TriggerMode=On")));
  EXPECT_THAT(camera.writes, Contains("AcquisitionFrameRate=20"));
  EXPECT_THAT(camera.writes, Contains("ExposureAuto=Continuous"));
  EXPECT_THAT(camera.writes, Contains("GainAuto=Continuous"));
  EXPECT_THAT(camera.writes, Not(Contains("ExposureTime=0")));
}

}  // namespace
}  // namespace edgesplat::aravis
