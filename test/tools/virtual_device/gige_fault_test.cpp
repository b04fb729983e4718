// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// A GigE Vision camera that fails in mid-run: noticed within 1 s, back within 3 s of its return, one line in
// the log and one count for each.
#include "test/tools/virtual_device/gige_loopback.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <string>

namespace edgesplat::virtual_device {
namespace {

using namespace std::chrono_literals;

/// The times are claimed for the product: under a sanitizer, or while others use the machine up, they are
/// longer.
int slower() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return 5;
#else
  double load = 0.0;
  const bool busy = ::getloadavg(&load, 1) == 1 && load > 2.0 * std::thread::hardware_concurrency();
  return busy ? 3 : 1;
#endif
}
const int kSlower = slower();

class GigeFault : public testing::Test {
 protected:
  void SetUp() override {
    if (!aravis::has_aravis()) GTEST_SKIP() << "built without libaravis";
    options_.address = test::own_loopback_address();
    options_.model = {.width_px = 160, .height_px = 120, .serial = "F-1"};
    camera_.emplace(options_, 10.0);
    auto config = robot_config_for(options_);
    config.silence_s = 0.6 * std::min(kSlower, 2);
    config.ptp_wait_s = 0.0;
    robot_ = aravis::GigeCamera::create(config, {160, 120}, clock_).value();
    camera_->start_pulses();
    ASSERT_TRUE(run_until([&] { return robot_->counters().frames >= 5; }, 10s));
  }
  /// Receives until `done`; false where it did not come true in time.
  bool run_until(const std::function<bool()>& done, nanoseconds limit) {
    const HostTime until = clock_.now() + limit;
    while (clock_.now() < until) {
      if (done()) return true;
      if (auto measurement = robot_->receive({}, 20ms)) newest_ = std::get<sensor::CameraFrame>(*measurement);
    }
    return done();
  }
  /// Faults begin; then, for a while after they were noticed, they last; then they end.
  void suffer(const std::function<void()>& begin, const std::function<void()>& end, int moves = 0) {
    testing::internal::CaptureStderr();
    begin();
    EXPECT_TRUE(run_until([&] { return !robot_->streaming(); }, kSlower * 1s)) << "not noticed";
    (void)run_until([] { return false; }, 2s);
    end();
    const auto before = robot_->counters().frames;
    EXPECT_TRUE(
        run_until([&] { return robot_->streaming() && robot_->counters().frames > before; }, kSlower * 3s))
        << "not back";
    (void)run_until([] { return false; }, 500ms);
    log_ = testing::internal::GetCapturedStderr();
    EXPECT_TRUE(robot_->streaming());
    EXPECT_EQ(lines_with("frames stopped"), 1) << log_;
    EXPECT_EQ(lines_with("frames come again"), 1) << log_;
    EXPECT_EQ(lines_with("has another address"), moves) << log_;
    EXPECT_EQ(lines_with(" camera: "), 2 + moves) << log_;
    const auto& session = robot_->session_counters();
    EXPECT_EQ(session.silences + session.control_losses, 1U);
    EXPECT_EQ(session.recoveries, 1U);
    EXPECT_EQ(session.moves, static_cast<std::uint64_t>(moves));
    EXPECT_LT(robot_->counters().incomplete, 10U) << "no more than were on their way when it began";
  }
  [[nodiscard]] int lines_with(const std::string& what) const {
    int count = 0;
    for (auto at = log_.find(what); at != std::string::npos; at = log_.find(what, at + 1)) ++count;
    return count;
  }

  SteadyClock clock_;
  GigeServerOptions options_;
  std::optional<PulsedCamera> camera_;
  std::unique_ptr<aravis::GigeCamera> robot_;
  std::optional<sensor::CameraFrame> newest_;
  std::string log_;
};

TEST_F(GigeFault, Unplugged) {
  suffer([&] { camera_->server().set_faults({.silent = true}); }, [&] { camera_->server().set_faults({}); });
}

TEST_F(GigeFault, HalfOpen) {
  suffer([&] { camera_->server().set_faults({.half_open = true}); },
         [&] { camera_->server().set_faults({}); });
}

TEST_F(GigeFault, RestartedWithItsClockReset) {
  const auto switched_on = clock_.now() + 1s;
  suffer(
      [&] {
        camera_->stop_pulses();
        camera_->server().set_faults({.silent = true});
        camera_->server().reboot();
        camera_->server().set_clock(
            [=](HostTime now) { return sensor_time_from_ns(0) + (now - switched_on); });
      },
      [&] {
        camera_->set_epoch(0, switched_on);
        camera_->server().set_faults({});
        camera_->start_pulses();
      });
  ASSERT_TRUE(newest_.has_value());
  EXPECT_LT(to_ns(newest_->stamp), 100'000'000'000);  // its new clock
  EXPECT_EQ(robot_->counters().restarts, 1U);
}

TEST_F(GigeFault, BackAtANewAddress) {
  suffer([&] { camera_.reset(); },
         [&] {
           options_.address = test::own_loopback_address();
           camera_.emplace(options_, 10.0);
           camera_->start_pulses();
         },
         1);
}

TEST_F(GigeFault, BackAtANewAddressWhileAnotherCameraHasItsOldOne) {
  std::optional<PulsedCamera> other;
  suffer(
      [&] {
        camera_.reset();
        auto elsewhere = options_;
        elsewhere.model.serial = "F-2";
        other.emplace(elsewhere, 10.0);
        other->start_pulses();
      },
      [&] {
        options_.address = test::own_loopback_address();
        camera_.emplace(options_, 10.0);
        camera_->start_pulses();
      },
      1);
  EXPECT_EQ(other->server().counters().frames_sent, 0U);
}

TEST_F(GigeFault, TriggerLineBroken) {
  suffer([&] { camera_->stop_pulses(); }, [&] { camera_->start_pulses(); });
}

TEST_F(GigeFault, FivePercentLossIsNoOutage) {
  camera_->server().set_faults({.loss = 0.05});
  const auto before = robot_->counters().frames;
  EXPECT_TRUE(run_until([&] { return robot_->counters().frames >= before + 50; }, kSlower * 6s));
  EXPECT_EQ(robot_->session_counters().silences, 0U);
  EXPECT_EQ(robot_->session_counters().control_losses, 0U);
  EXPECT_EQ(robot_->counters().lost, 0U);
}

TEST_F(GigeFault, TheEndOfTheProgramDoesNotWaitForACameraThatIsGone) {
  camera_->server().set_faults({.silent = true});
  (void)run_until([&] { return !robot_->streaming(); }, kSlower * 2s);
  const HostTime begin = clock_.now();
  robot_.reset();
  EXPECT_LT(clock_.now() - begin, kSlower * 3s);
}

}  // namespace
}  // namespace edgesplat::virtual_device
