// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// A virtual LiDAR and the robot's driver over real sockets: neither side shares code with the other.
#include "tools/virtual_device/lidar_device.hpp"

#include "common/time/clock.hpp"
#include "robot/drivers/livox/lidar_driver.hpp"
#include "tools/simulate/livox_encoder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace edgesplat::virtual_device {
namespace {

using namespace std::chrono_literals;
using Kind = livox::LidarEventKind;

constexpr std::int64_t kRecorded_ns = 1'700'000'000'000'000'000;

/// Addresses and a serial number that no other test on this machine has at the same time.
std::array<std::uint8_t, 4> own_ip(std::uint8_t last) {
  const auto pid = static_cast<unsigned>(::getpid());
  return {127, static_cast<std::uint8_t>(10 + (pid >> 8U) % 200), static_cast<std::uint8_t>(pid & 0xFFU),
          last};
}
std::string text_of(const std::array<std::uint8_t, 4>& ip) {
  return livox::to_string(ip);
}

/// The robot's driver on a thread of its own.
class RobotEnd {
 public:
  RobotEnd(LidarModel model, const std::string& serial_number) {
    livox::LidarDriverConfig config;
    config.choice = model == LidarModel::kAvia ? livox::LidarChoice::kAvia : livox::LidarChoice::kMid360;
    config.serial_number = serial_number;
    config.transport.bind_address = text_of(own_ip(1));
    config.transport.points_port = config.transport.imu_port = 0;
    config.transport.control_port = config.transport.push_port = 0;
    auto opened = livox::LidarDriver::open(config, clock_,
                                           {[this](const sensor::Measurement& one) { take(one); },
                                            [this](const livox::LidarEvent& event) {
                                              const std::lock_guard lock(mutex_);
                                              events_.push_back(event);
                                            },
                                            {}});
    if (!opened) {
      ADD_FAILURE() << opened.error().context;
      return;
    }
    driver_ = std::move(*opened);
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) EXPECT_TRUE(driver_->step(stop));
      driver_->stop();
    });
  }
  ~RobotEnd() { end(); }
  void end() {
    if (!thread_.joinable()) return;
    thread_.request_stop();
    thread_.join();
  }
  [[nodiscard]] const livox::LidarDriver& driver() const { return *driver_; }
  [[nodiscard]] std::size_t count(Kind kind) {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(
        std::count_if(events_.begin(), events_.end(),
                      [kind](const livox::LidarEvent& event) { return event.kind == kind; }));
  }
  [[nodiscard]] bool wait_for(Kind kind, std::chrono::milliseconds timeout) {
    for (; timeout > 0ms; timeout -= 10ms) {
      if (count(kind) > 0) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }

  std::atomic<std::uint64_t> packets = 0;
  std::atomic<std::uint64_t> samples = 0;
  std::atomic<std::int64_t> worst_stamp_error_ns = 0;

 private:
  /// Each packet's first range in mm is its number, so its true time is known.
  void take(const sensor::Measurement& one) {
    if (std::holds_alternative<sensor::ImuSample>(one)) ++samples;
    const auto* packet = std::get_if<sensor::LidarPacket>(&one);
    if (packet == nullptr) return;
    ++packets;
    const double number = std::round(packet->points.front().p_in_lidar_m.x() * 1e3F) - 1000.0;
    const std::int64_t true_ns = kRecorded_ns + static_cast<std::int64_t>(number) * 1'000'000;
    const std::int64_t error_ns = std::abs(to_ns(packet->stamp) - true_ns);
    if (error_ns > worst_stamp_error_ns) worst_stamp_error_ns = error_ns;
  }

  SteadyClock clock_;
  std::unique_ptr<livox::LidarDriver> driver_;
  std::mutex mutex_;
  std::vector<livox::LidarEvent> events_;
  std::jthread thread_;
};

/// A packet a millisecond and an IMU sample every five, for `seconds`.
void play(LidarDevice& device, double seconds) {
  const auto begin = std::chrono::steady_clock::now();
  device.begin(host_time_from_ns(kRecorded_ns));
  for (int ms = 0; ms < static_cast<int>(seconds * 1e3); ++ms) {
    std::this_thread::sleep_until(begin + std::chrono::milliseconds(ms));
    const std::int64_t at_ns = kRecorded_ns + ms * 1'000'000LL;
    std::array<simulate::WirePoint, simulate::kPointsPerPacket> points{};
    points.fill({1000 + ms, 0, 0, 10, 0});
    const simulate::PacketStamp stamp{static_cast<std::uint16_t>(ms), sensor_time_from_ns(at_ns),
                                      nanoseconds(475'000), sensor::StampSource::kPtp};
    device.points(simulate::encode_point_packet(stamp, points), host_time_from_ns(at_ns));
    if (ms % 5 == 0)
      device.imu(simulate::encode_imu_packet(stamp, Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitZ()),
                 host_time_from_ns(at_ns));
  }
}

class LidarDeviceTest : public testing::TestWithParam<LidarModel> {
 protected:
  [[nodiscard]] LidarDeviceConfig config() const {
    LidarDeviceConfig config;
    config.model = GetParam();
    config.unit.serial_number = serial_number_;
    config.unit.ip = own_ip(10);
    return config;
  }
  std::string serial_number_ = "47MT" + std::to_string(1'000'000'000 + ::getpid());
  SteadyClock clock_;
};

TEST_P(LidarDeviceTest, IsFoundStartedAndHeardInFull) {
  auto device = LidarDevice::start(config(), clock_);
  ASSERT_TRUE(device.has_value()) << device.error().context;
  RobotEnd robot(GetParam(), serial_number_);
  ASSERT_TRUE((*device)->wait_for_host(10s, {}));
  play(**device, 2.0);
  std::this_thread::sleep_for(100ms);
  robot.end();
  EXPECT_EQ(robot.packets, 2000U);
  EXPECT_EQ(robot.samples, 400U);
  // An Avia's losses show in the time between packets, and here it is not an Avia's.
  if (GetParam() == LidarModel::kMid360) {
    EXPECT_EQ(robot.driver().source_counters().points.lost, 0U);
  }
  EXPECT_LT(robot.worst_stamp_error_ns, 20'000) << "the noise of its servo, 3 us";
  EXPECT_EQ(robot.count(Kind::kFound), 1U);
  const auto counters = (*device)->counters();
  EXPECT_EQ(counters.unsent, 0U);
  EXPECT_EQ(counters.unit.sessions, 1U);
  EXPECT_EQ(counters.unit.bad_frames, 0U);
}

TEST_P(LidarDeviceTest, ComesBackFromEveryFault) {
  LidarDeviceConfig faulty = config();
  const std::string elsewhere = text_of(own_ip(11));
  for (const std::string& text : {std::string("silence@0.5+1.0"), std::string("reboot@3+0.2"),
                                  "address@5.5+0.2=" + elsewhere, std::string("loss@8+1.5=0.05")}) {
    const auto fault = parse_lidar_fault(text);
    ASSERT_TRUE(fault.has_value()) << fault.error().context;
    faulty.faults.push_back(*fault);
  }
  auto device = LidarDevice::start(faulty, clock_);
  ASSERT_TRUE(device.has_value()) << device.error().context;
  RobotEnd robot(GetParam(), serial_number_);
  ASSERT_TRUE((*device)->wait_for_host(10s, {}));
  play(**device, 10.0);
  robot.end();
  EXPECT_GE(robot.count(Kind::kSilent), 3U);  // more on a machine that stalls for half a second
  EXPECT_EQ(robot.count(Kind::kRecovered), robot.count(Kind::kSilent));
  EXPECT_EQ(robot.count(Kind::kMoved), 1U);
  EXPECT_EQ((*device)->counters().faults, 4U);
  EXPECT_GT((*device)->counters().lost, 20U);
  EXPECT_GT(robot.driver().source_counters().points.lost, 20U);
}

INSTANTIATE_TEST_SUITE_P(Models, LidarDeviceTest, testing::Values(LidarModel::kMid360, LidarModel::kAvia),
                         [](const testing::TestParamInfo<LidarModel>& model) {
                           return model.param == LidarModel::kMid360 ? "Mid360" : "Avia";
                         });

TEST(LidarDevice, ATakenAddressIsSaid) {
  const SteadyClock clock;
  LidarDeviceConfig config;
  config.unit.ip = own_ip(12);
  const auto first = LidarDevice::start(config, clock);
  ASSERT_TRUE(first.has_value());
  const auto second = LidarDevice::start(config, clock);
  ASSERT_FALSE(second.has_value());
  EXPECT_EQ(second.error().code, Errc::kIo);
  EXPECT_NE(second.error().context.find(text_of(own_ip(12))), std::string::npos) << second.error().context;
}

TEST(LidarFault, ReadsWhatItWrites) {
  const auto address = parse_lidar_fault("address@8+0.5=127.0.0.9");
  ASSERT_TRUE(address.has_value()) << address.error().context;
  EXPECT_EQ(address->kind, LidarFault::Kind::kAddress);
  EXPECT_EQ(address->at_s, 8.0);
  EXPECT_EQ(address->lasts_s, 0.5);
  EXPECT_EQ(address->address, (std::array<std::uint8_t, 4>{127, 0, 0, 9}));
  EXPECT_EQ(parse_lidar_fault("loss@10+5=0.05")->value, 0.05);
  EXPECT_EQ(parse_lidar_fault("stuck-sync@12")->kind, LidarFault::Kind::kStuckSync);
  EXPECT_EQ(parse_lidar_fault("clock-step@1=-0.2")->value, -0.2);
  for (const char* wrong :
       {"", "silence", "silence@1", "silence@-1+2", "silence@1+2=3", "reboot@x+1", "loss@1+1=2",
        "address@1+1=", "address@1+1=300.0.0.1", "stuck-sync@", "stuck-sync@1+1", "fire@1+1"})
    EXPECT_EQ(parse_lidar_fault(wrong).error().code, Errc::kInvalidConfig) << wrong;
}

TEST(UnitClock, RunsFreeFollowsAMasterAndLies) {
  constexpr std::int64_t kOn_ns = kRecorded_ns;
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  UnitClock free({.sync = UnitSync::kNone, .drift_ppm = -50.0}, kOn_ns);
  EXPECT_EQ(free.held_by(kOn_ns + kSecond_ns), UnitSync::kNone);
  EXPECT_EQ(free.stamp_ns(kOn_ns + 100 * kSecond_ns), 100 * kSecond_ns - 5'000'000);
  free.restart(kOn_ns + 200 * kSecond_ns);
  EXPECT_EQ(free.stamp_ns(kOn_ns + 201 * kSecond_ns), kSecond_ns - 50'000);

  UnitClock ptp({.sync = UnitSync::kPtp, .drift_ppm = 50.0, .servo_sigma_s = 1e-6, .lock_after_s = 0.5},
                kOn_ns);
  EXPECT_EQ(ptp.held_by(kOn_ns + kSecond_ns / 4), UnitSync::kNone);
  double worst_ns = 0;
  for (int k = 1; k < 1000; ++k) {
    const std::int64_t at_ns = kOn_ns + k * kSecond_ns / 3 + kSecond_ns;
    EXPECT_EQ(ptp.held_by(at_ns), UnitSync::kPtp);
    worst_ns = std::max(worst_ns, std::abs(static_cast<double>(ptp.stamp_ns(at_ns) - at_ns)));
  }
  EXPECT_GT(worst_ns, 1'000.0);
  EXPECT_LT(worst_ns, 5'000.0);
  ptp.step_master(200'000'000);
  const std::int64_t lost_ns = kOn_ns + 400 * kSecond_ns;
  EXPECT_NEAR(static_cast<double>(ptp.stamp_ns(lost_ns) - lost_ns), 2e8, 5e3);
  ptp.lose_master(lost_ns);
  const std::int64_t later_ns = lost_ns + 100 * kSecond_ns;
  EXPECT_EQ(ptp.held_by(later_ns), UnitSync::kPtp) << "it does not say so";
  EXPECT_NEAR(static_cast<double>(ptp.stamp_ns(later_ns) - later_ns), 2e8 + 5e6, 5e3);
}

}  // namespace
}  // namespace edgesplat::virtual_device
