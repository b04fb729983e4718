// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// A GigE Vision camera is its serial number, not its address. How long it takes is held by gige_fault_test.
#include "robot/drivers/aravis/gvcp_finder.hpp"
#include "test/tools/virtual_device/gige_loopback.hpp"

#include <unistd.h>

#include <optional>
#include <string>

namespace edgesplat::virtual_device {
namespace {

using namespace std::chrono_literals;

/// Every virtual camera of this machine hears the search, those of other tests too.
std::string own_serial(const std::string& name) {
  return name + "-" + std::to_string(::getpid());
}

GigeServerOptions camera_named(const std::string& serial, const std::string& address) {
  GigeServerOptions options;
  options.address = address;
  options.model = {.width_px = 64, .height_px = 48, .serial = serial};
  return options;
}

class GigeMoved : public testing::Test {
 protected:
  void SetUp() override {
    if (!aravis::has_aravis()) GTEST_SKIP() << "built without libaravis";
  }
  /// Receives until a frame comes whose stamp is past `epoch_ns`: the frames of a camera with that clock.
  static bool frame_after(aravis::GigeCamera& robot, std::int64_t epoch_ns) {
    const auto until = std::chrono::steady_clock::now() + 30s;
    while (std::chrono::steady_clock::now() < until) {
      const auto measurement = robot.receive({}, 100ms);
      if (measurement && to_ns(std::get<sensor::CameraFrame>(*measurement).stamp) > epoch_ns) return true;
    }
    return false;
  }
  SteadyClock clock_;
};

TEST(GigeFinder, FindsACameraByItsSerialNumberAmongOthers) {
  const SteadyClock clock;
  const std::string first_at = test::own_loopback_address(), second_at = test::own_loopback_address();
  const auto first = GigeServer::open(camera_named(own_serial("A"), first_at), clock);
  const auto second = GigeServer::open(camera_named(own_serial("B"), second_at), clock);
  ASSERT_TRUE(first && second);
  aravis::GvcpFinder finder;
  for (const auto& [name, at] :
       {std::pair(own_serial("A"), first_at), std::pair(own_serial("B"), second_at)}) {
    const auto found = finder.find(
        [&name](const aravis::FoundCamera& camera) { return camera.serial_number == name; }, {}, 20s);
    ASSERT_TRUE(found.has_value()) << name;
    EXPECT_EQ(found->address, at);
    EXPECT_EQ(found->maker, "edgesplat");
    const auto asked = finder.ask(at, {}, 20s);
    ASSERT_TRUE(asked.has_value()) << at;
    EXPECT_TRUE(aravis::is_same_camera(*asked, *found));
  }
}

TEST_F(GigeMoved, ItsSerialNumberIsEnoughToOpenIt) {
  const auto options = camera_named(own_serial("C"), test::own_loopback_address());
  PulsedCamera camera(options, 20.0);
  camera.start_pulses();
  auto config = robot_config_for(options);
  config.address = test::own_loopback_address();  // nobody is there
  config.serial_number = own_serial("C");
  config.ptp_wait_s = 0.0;
  const auto robot = aravis::GigeCamera::create(config, {64, 48}, clock_).value();
  EXPECT_TRUE(frame_after(*robot, kGigeEpoch_ns));
  EXPECT_EQ(robot->session_counters().moves, 0U);
}

TEST_F(GigeMoved, ItIsFollowedToANewAddressAndAnotherAtItsOldOneIsNotTaken) {
  const std::int64_t day_ns = 86'400'000'000'000;
  const auto options = camera_named(own_serial("D"), test::own_loopback_address());
  std::optional<PulsedCamera> camera(std::in_place, options, 20.0);
  camera->start_pulses();
  auto config = robot_config_for(options);
  config.ptp_wait_s = 0.0;
  config.silence_s = 1.0;
  const auto robot = aravis::GigeCamera::create(config, {64, 48}, clock_).value();
  ASSERT_TRUE(frame_after(*robot, kGigeEpoch_ns));

  testing::internal::CaptureStderr();
  camera.reset();
  PulsedCamera other(camera_named(own_serial("E"), options.address), 20.0);
  other.set_epoch(kGigeEpoch_ns + day_ns, clock_.now());
  other.start_pulses();
  camera.emplace(camera_named(own_serial("D"), test::own_loopback_address()), 20.0);
  camera->set_epoch(kGigeEpoch_ns + 2 * day_ns, clock_.now());
  camera->start_pulses();
  EXPECT_TRUE(frame_after(*robot, kGigeEpoch_ns + 2 * day_ns));
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_EQ(robot->session_counters().moves, 1U);
  const auto line = log.find("has another address");
  ASSERT_NE(line, std::string::npos) << log;
  EXPECT_EQ(log.find("has another address", line + 1), std::string::npos) << log;
  EXPECT_EQ(other.server().counters().frames_sent, 0U);
}

}  // namespace
}  // namespace edgesplat::virtual_device
