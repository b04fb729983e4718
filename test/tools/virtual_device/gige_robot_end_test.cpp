// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The robot's GigE Vision driver (on libaravis) and the virtual camera: neither shares code with the other.
#include "robot/drivers/aravis/aravis_camera.hpp"
#include "test/tools/virtual_device/gige_loopback.hpp"

#include <optional>

namespace edgesplat::virtual_device {
namespace {

using namespace std::chrono_literals;

GigeServerOptions small_camera(GigeVocabulary vocabulary = GigeVocabulary::kSfnc) {
  GigeServerOptions options;
  options.address = test::own_loopback_address();
  options.model.width_px = 160;
  options.model.height_px = 120;
  options.model.vocabulary = vocabulary;  // the serial number comes from the address: each test has its own
  return options;
}

sensor::CameraFrame next_frame(aravis::GigeCamera& camera) {
  auto measurement = camera.receive({}, 8s);
  EXPECT_TRUE(measurement.has_value());
  return measurement ? std::get<sensor::CameraFrame>(*measurement) : sensor::CameraFrame{};
}

class GigeRobotEnd : public testing::Test {
 protected:
  void SetUp() override {
    if (!aravis::has_aravis()) GTEST_SKIP() << "built without libaravis";
  }
  static std::unique_ptr<aravis::GigeCamera> robot_camera(const aravis::GigeCameraConfig& config,
                                                          const Clock& clock) {
    auto created = aravis::GigeCamera::create(config, {160, 120}, clock);
    EXPECT_TRUE(created.has_value());
    return *std::move(created);
  }
  SteadyClock clock_;
};

/// Receives `count` frames and compares each with what was exposed at its pulse.
void expect_intact(aravis::GigeCamera& robot, const PulsedCamera& camera, int count, int may_miss = 0) {
  std::optional<std::uint32_t> previous;
  for (int i = 0; i < count; ++i) {
    const auto frame = next_frame(robot);
    ASSERT_NE(frame.image, nullptr);
    const std::uint32_t k = camera.pulse_of(frame.stamp);
    const GigeExposure sent = camera.exposure(k);
    EXPECT_EQ(frame.image->values, sent.image->values) << "pulse " << k;
    EXPECT_EQ(to_ns(frame.stamp), to_ns(sent.start) + std::llround(500.0 * sent.exposure_us))
        << "pulse " << k;
    EXPECT_FLOAT_EQ(frame.exposure_s, sent.exposure_us * 1e-6F);
    EXPECT_FLOAT_EQ(frame.gain_db, sent.gain_db);
    EXPECT_EQ(frame.stamp_source, sensor::StampSource::kPtp);
    if (previous && kMustKeepUp) {
      may_miss -= static_cast<int>(k - *previous - 1);
      EXPECT_GE(may_miss, 0) << "a frame was lost before pulse " << k;
    }
    previous = k;
  }
}

TEST_F(GigeRobotEnd, EveryFrameComesIntactWithItsStampExposureAndGain) {
  const auto options = small_camera();
  PulsedCamera camera(options, 50.0);
  camera.start_pulses();
  const auto robot = robot_camera(robot_config_for(options), clock_);
  expect_intact(*robot, camera, 60);
  if (!kMustKeepUp) return;
  EXPECT_EQ(robot->counters().lost, 0U);
  EXPECT_EQ(robot->statistics().failed, 0U);
}

TEST_F(GigeRobotEnd, ArrivalIsTheMomentOfTheStampByAFreeClock) {
  const auto options = small_camera();
  PulsedCamera camera(options, 50.0);
  camera.start_pulses();
  auto config = robot_config_for(options);
  config.ptp = false;
  const auto robot = robot_camera(config, clock_);
  for (int i = 0; i < 50; ++i) {
    const auto frame = next_frame(*robot);
    EXPECT_EQ(frame.stamp_source, sensor::StampSource::kFreeRunning);
    EXPECT_NEAR(to_seconds(frame.arrival - camera.host_time_of(frame.stamp)), 0.0, 1e-3);
  }
}

TEST_F(GigeRobotEnd, FivePercentLossIsRepairedByResends) {
  const auto options = small_camera();
  PulsedCamera camera(options, 20.0);
  auto config = robot_config_for(options);
  config.packet_bytes = 1500;  // 41 packets a frame
  const auto robot = robot_camera(config, clock_);
  camera.start_pulses();
  expect_intact(*robot, camera, 5);
  camera.server().set_faults({.loss = 0.05});
  expect_intact(*robot, camera, 60, 2);
  EXPECT_GT(camera.server().counters().packets_lost, 50U);
  EXPECT_GT(robot->statistics().packets_resent, 50U);
  EXPECT_LE(robot->counters().incomplete, 2U);  // without resends: 88 % of them
}

// What has not come yet is asked for too, and must not use up the questions for what is lost.
TEST_F(GigeRobotEnd, LossIsRepairedInFramesThatAreHeldUpOnTheWay) {
  const auto options = small_camera();
  PulsedCamera camera(options, 10.0);
  auto config = robot_config_for(options);
  config.packet_bytes = 1500;
  const auto robot = robot_camera(config, clock_);
  camera.start_pulses();
  expect_intact(*robot, camera, 3);
  camera.server().set_faults({.loss = 0.05, .held_up_s = 0.03});
  expect_intact(*robot, camera, 15, 1);
  EXPECT_GT(camera.server().counters().packets_lost, 15U);
}

TEST_F(GigeRobotEnd, ARobotThatWasHeldUpDoesNotCallTheCameraSilent) {
  const auto options = small_camera();
  PulsedCamera camera(options, 10.0);
  const auto robot = robot_camera(robot_config_for(options), clock_);
  camera.start_pulses();
  expect_intact(*robot, camera, 3);
  std::this_thread::sleep_for(900ms);  // longer than silence_s
  expect_intact(*robot, camera, 5);
  EXPECT_EQ(robot->session_counters().opens, 1U);
  EXPECT_EQ(robot->session_counters().silences, 0U);
}

TEST_F(GigeRobotEnd, AnIncompleteFrameIsCountedAndNeverUsed) {
  const auto options = small_camera();
  PulsedCamera camera(options, 20.0);
  auto config = robot_config_for(options);
  config.packet_bytes = 576;  // 107 packets a frame: of 70 % lost some stay lost
  const auto robot = robot_camera(config, clock_);
  camera.start_pulses();
  expect_intact(*robot, camera, 3);
  camera.server().set_faults({.loss = 0.7});
  for (int i = 0; i < 15; ++i) {
    const auto measurement = robot->receive({}, 200ms);
    if (!measurement) continue;
    const auto& frame = std::get<sensor::CameraFrame>(*measurement);
    EXPECT_EQ(frame.image->values, camera.exposure(camera.pulse_of(frame.stamp)).image->values);
  }
  EXPECT_GT(robot->counters().incomplete, 0U);
}

TEST_F(GigeRobotEnd, OlderNamesOfTheFeaturesDoTheSame) {
  const auto options = small_camera(GigeVocabulary::kOlder);
  PulsedCamera camera(options, 50.0);
  const auto robot = robot_camera(robot_config_for(options), clock_);
  camera.start_pulses();
  expect_intact(*robot, camera, 10);
}

TEST_F(GigeRobotEnd, WithoutPtpAndChunksStampsAreFreeAndTheExposureIsTheOneThatWasSet) {
  const auto options = small_camera(GigeVocabulary::kWithoutPtp);
  PulsedCamera camera(options, 50.0);
  auto config = robot_config_for(options);
  config.exposure_us = 8000.0;
  const auto robot = robot_camera(config, clock_);
  camera.start_pulses();
  const auto frame = next_frame(*robot);
  EXPECT_EQ(frame.stamp_source, sensor::StampSource::kFreeRunning);
  EXPECT_FLOAT_EQ(frame.exposure_s, 0.008F);
  EXPECT_EQ(to_ns(frame.stamp) - to_ns(camera.exposure(camera.pulse_of(frame.stamp)).start), 4'000'000);
}

TEST_F(GigeRobotEnd, ThePacketSizeIsTheLargestThatGetsThrough) {
  auto options = small_camera();
  options.path_bytes = 1500;
  PulsedCamera camera(options, 50.0);
  auto opened = aravis::AravisCamera::open(robot_config_for(options), clock_);
  ASSERT_TRUE(opened.has_value()) << opened.error().context;
  EXPECT_GT((*opened)->packet_bytes(), 1450);
  EXPECT_LE((*opened)->packet_bytes(), 1500);
}

TEST_F(GigeRobotEnd, APulseThatTheCameraMissedIsCounted) {
  const auto options = small_camera();
  PulsedCamera camera(options, 50.0);
  const auto robot = robot_camera(robot_config_for(options), clock_);
  camera.start_pulses();
  (void)next_frame(*robot);
  camera.server().miss_pulse();
  for (int i = 0; i < 10; ++i) (void)next_frame(*robot);
  EXPECT_EQ(robot->counters().missed_pulses, 1U);
  EXPECT_EQ(robot->counters().lost, 0U);
}

TEST_F(GigeRobotEnd, ASecondProgramIsToldThatTheCameraIsTaken) {
  const auto options = small_camera();
  PulsedCamera camera(options, 50.0);
  auto first = aravis::AravisCamera::open(robot_config_for(options), clock_);
  ASSERT_TRUE(first.has_value());
  const auto second = aravis::AravisCamera::open(robot_config_for(options), clock_);
  ASSERT_FALSE(second.has_value());
  EXPECT_EQ(second.error().code, Errc::kUnavailable);
}

TEST_F(GigeRobotEnd, TheCameraClockIsReadWithinTheRoundTrip) {
  const auto options = small_camera();
  PulsedCamera camera(options, 50.0);
  auto opened = aravis::AravisCamera::open(robot_config_for(options), clock_);
  ASSERT_TRUE(opened.has_value());
  camera.start_pulses();
  std::this_thread::sleep_for(100ms);
  camera.stop_pulses();
  const auto first = (*opened)->read_clock();
  std::this_thread::sleep_for(100ms);
  const auto second = (*opened)->read_clock();
  ASSERT_TRUE(first && second);
  const double device_ns = static_cast<double>((second->device - first->device).count());
  const double host_ns = static_cast<double>((second->host - first->host).count());
  EXPECT_NEAR(device_ns, host_ns, static_cast<double>((first->round_trip + second->round_trip).count()));
}

}  // namespace
}  // namespace edgesplat::virtual_device
