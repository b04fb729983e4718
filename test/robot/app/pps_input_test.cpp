// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/pps_input.hpp"

#include "robot/drivers/livox/lidar_driver.hpp"
#include "tools/virtual_device/lidar_device.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

namespace edgesplat::app {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kStart_ns = 1'700'000'000 * kSecond_ns;

struct Told {
  HostTime edge;
  std::int64_t utc_ns;
};

/// The kernel's edges in virtual time: each is read `read_after_ns` after it came; then the run ends.
class Line {
 public:
  explicit Line(std::vector<std::int64_t> edges_ns) : edges_ns_(std::move(edges_ns)) {}
  void fail_before(std::size_t edge) { fails_before_ = edge; }
  std::int64_t read_after_ns = 50'000;

  PpsInput& play(const robot_config::PpsSettings& settings) {
    input_.emplace(
        settings, [this](double) { return next(); }, clock_, [this] { return wall_ns_; });
    input_->receive(stop_.get_token(), [this](HostTime edge, std::int64_t utc_ns) {
      told.push_back({edge, utc_ns});
    });
    return *input_;
  }
  /// The program's time that belongs to a time of the wall clock.
  [[nodiscard]] static HostTime host_time_of(std::int64_t wall_ns) {
    return host_time_from_ns(wall_ns - kStart_ns + 77 * kSecond_ns);
  }
  std::vector<Told> told;

 private:
  Result<std::optional<sync::PpsEdge>> next() {
    if (at_ == fails_before_) {
      fails_before_ = SIZE_MAX;
      return fail(Errc::kIo, "the line is gone");
    }
    if (at_ == edges_ns_.size()) {
      stop_.request_stop();
      return std::optional<sync::PpsEdge>();
    }
    wall_ns_ = edges_ns_[at_] + read_after_ns;
    clock_.advance_to(host_time_of(wall_ns_));
    return sync::PpsEdge{static_cast<std::uint32_t>(at_), edges_ns_[at_++]};
  }
  std::vector<std::int64_t> edges_ns_;
  std::size_t at_ = 0;
  std::size_t fails_before_ = SIZE_MAX;
  std::int64_t wall_ns_ = kStart_ns;
  VirtualClock clock_;
  std::stop_source stop_;
  std::optional<PpsInput> input_;
};

TEST(PpsInput, TellsEachEdgeWithTheSecondItBegan) {
  // A wall clock that is 4 ms behind.
  Line line(
      {kStart_ns - 4'000'000, kStart_ns + kSecond_ns - 4'000'000, kStart_ns + 2 * kSecond_ns - 4'000'000});
  const PpsInput& input = line.play({});
  ASSERT_EQ(line.told.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    const Told& one = line.told.at(static_cast<std::size_t>(i));
    EXPECT_EQ(one.utc_ns, kStart_ns + i * kSecond_ns);
    EXPECT_EQ(one.edge, Line::host_time_of(kStart_ns + i * kSecond_ns - 4'000'000));
  }
  EXPECT_EQ(input.counters().told, 3U);
}

TEST(PpsInput, EdgesAnywhereAreToldAsTheyWereOrNotAtAll) {
  const std::vector<std::int64_t> edges{kStart_ns + 420'000'000, kStart_ns + kSecond_ns + 420'001'000};
  Line anywhere(edges);
  (void)anywhere.play({.device = "", .on_seconds = false});
  ASSERT_EQ(anywhere.told.size(), 2U);
  EXPECT_EQ(anywhere.told[1].utc_ns, edges[1]);

  Line on_seconds(edges);
  testing::internal::CaptureStderr();
  EXPECT_EQ(on_seconds.play({}).counters().off_second, 2U);
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_TRUE(on_seconds.told.empty());
  const auto line = log.find("not in order");
  ASSERT_NE(line, std::string::npos) << log;
  EXPECT_EQ(log.find("not in order", line + 1), std::string::npos) << "once";
}

TEST(PpsInput, StraysAndEdgesReadTooLateAreNotTold) {
  Line strays({kStart_ns, kStart_ns + 300'000'000, kStart_ns + kSecond_ns});
  (void)strays.play({});
  EXPECT_EQ(strays.told.size(), 2U);
  Line late({kStart_ns, kStart_ns + kSecond_ns});
  late.read_after_ns = 1'100'000'000;
  EXPECT_EQ(late.play({}).counters().stale, 2U);
  EXPECT_TRUE(late.told.empty());
}

TEST(PpsInput, ALineThatFailsIsTriedAgain) {
  Line line({kStart_ns, kStart_ns + kSecond_ns});
  line.fail_before(1);
  EXPECT_EQ(line.play({}).counters().failures, 1U);
  EXPECT_EQ(line.told.size(), 2U);
}

TEST(PpsInput, ADeviceThatIsNotThereIsAnErrorAtOnce) {
  const SteadyClock clock;
  const auto opened = PpsInput::open({.device = "/dev/no-such-pps", .on_seconds = true}, clock);
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().code, Errc::kIo);
}

std::int64_t wall_ns() {
  timespec now{};
  (void)::clock_gettime(CLOCK_REALTIME, &now);
  return std::int64_t{now.tv_sec} * kSecond_ns + now.tv_nsec;
}

/// A pulse at each full second of the machine's clock, as the kernel would report it.
Result<std::optional<sync::PpsEdge>> next_full_second(double timeout_s) {
  const std::int64_t now_ns = wall_ns();
  const std::int64_t edge_ns = now_ns - now_ns % kSecond_ns + kSecond_ns;
  const auto left = nanoseconds(edge_ns - now_ns);
  if (left > from_seconds(timeout_s)) {
    std::this_thread::sleep_for(from_seconds(timeout_s));
    return std::optional<sync::PpsEdge>();
  }
  std::this_thread::sleep_for(left);
  return sync::PpsEdge{static_cast<std::uint32_t>(edge_ns / kSecond_ns), edge_ns};
}

/// From the pulse to a LiDAR whose clock it holds, over real sockets.
class PulseToLidar : public testing::TestWithParam<virtual_device::LidarModel> {};

TEST_P(PulseToLidar, ItsClockIsHeldByTheSecondsThatItIsTold) {
  const SteadyClock clock;
  const bool is_avia = GetParam() == virtual_device::LidarModel::kAvia;
  const std::string base =
      "127." + std::to_string(10 + (::getpid() >> 8) % 200) + "." + std::to_string(::getpid() & 0xFF) + ".";
  virtual_device::LidarDeviceConfig config;
  config.model = GetParam();
  config.unit.serial_number = "47MP" + std::to_string(1'000'000'000 + ::getpid());
  config.unit.ip = virtual_device::parse_address(base + "10").value();
  config.unit.clock.sync = virtual_device::UnitSync::kPulse;
  auto device = virtual_device::LidarDevice::start(config, clock);
  ASSERT_TRUE(device.has_value()) << device.error().context;

  livox::LidarDriverConfig driving;
  driving.choice = is_avia ? livox::LidarChoice::kAvia : livox::LidarChoice::kMid360;
  driving.serial_number = config.unit.serial_number;
  driving.feeds_utc = driving.sees_pulses = true;
  driving.transport.bind_address = base + "1";
  driving.transport.points_port = driving.transport.imu_port = 0;
  driving.transport.control_port = driving.transport.push_port = 0;
  const auto driver =
      livox::LidarDriver::open(driving, clock,
                               {[](const sensor::Measurement&) {}, [](const livox::LidarEvent&) {}, {}})
          .value();
  const std::jthread robot([&driver](const std::stop_token& stop) {
    while (!stop.stop_requested()) EXPECT_TRUE(driver->step(stop));
  });
  ASSERT_FALSE((*device)->wait_for_host(2s, {})) << "without pulses nobody tells it";
  EXPECT_EQ((*device)->counters().unit.seconds_told, 0U);
  PpsInput pps({}, next_full_second, clock, wall_ns);
  const std::jthread pulses([&](const std::stop_token& stop) {
    pps.receive(stop, [&driver](HostTime edge, std::int64_t utc_ns) { driver->on_pulse(edge, utc_ns); });
  });
  EXPECT_TRUE((*device)->wait_for_host(30s, {})) << "measures, its clock held";
  EXPECT_GE((*device)->counters().unit.seconds_told, 1U);
}

INSTANTIATE_TEST_SUITE_P(Models, PulseToLidar,
                         testing::Values(virtual_device::LidarModel::kMid360,
                                         virtual_device::LidarModel::kAvia),
                         [](const testing::TestParamInfo<virtual_device::LidarModel>& model) {
                           return model.param == virtual_device::LidarModel::kMid360 ? "Mid360" : "Avia";
                         });

}  // namespace
}  // namespace edgesplat::app
