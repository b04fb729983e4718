// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// What the robot takes for the time of a ray and of an inertial sample, against when the virtual Mid-360
// measured it: over real sockets, through the driver and the groups, at the full rate.
#include "tools/virtual_device/lidar_device.hpp"

#include "common/time/clock.hpp"
#include "robot/drivers/livox/lidar_driver.hpp"
#include "robot/sync/group_builder.hpp"
#include "tools/simulate/livox_encoder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace edgesplat::virtual_device {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kRecorded_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kPacket_ns = 480'000;  // 96 points of 200 000 a second
constexpr std::int64_t kSpan_ns = 475'000;    // first to last of them
constexpr std::int64_t kRay_ns = 5'000;       // between two
constexpr std::int64_t kSample_ns = 5'000'000;
constexpr int kPackets = 62'500;  // 30 s
constexpr double kWarmUp_s = 3.0;
constexpr nanoseconds kStandstill = 300ms;

std::string own_address(int last) {
  const int pid = ::getpid();
  return "127." + std::to_string(10 + (pid >> 8) % 200) + "." + std::to_string(pid & 0xFF) + "." +
         std::to_string(last);
}

/// Errors of times, in us.
class Errors {
 public:
  void add(HostTime on_line, std::int64_t true_ns) {
    us_.push_back(1e-3 * static_cast<double>(std::abs(to_ns(on_line) - true_ns)));
  }
  [[nodiscard]] std::size_t count() const { return us_.size(); }
  [[nodiscard]] double quantile(double q) {
    if (us_.empty()) return 1e9;
    const auto at = us_.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(us_.size() - 1));
    std::nth_element(us_.begin(), at, us_.end());
    return *at;
  }

 private:
  std::vector<double> us_;
};

/// The robot from its sockets to groups, on a thread of its own. Each ray's x in mm is its packet's number
/// and its y its number in it; each sample's turning about x in mrad/s is its number.
class RobotGroups {
 public:
  explicit RobotGroups(const std::string& serial_number) {
    sensor::Rig rig;
    rig.imu.emplace();
    builder_ = std::make_unique<sync::GroupBuilder>(sync::GroupBuilderConfig{}, rig);
    livox::LidarDriverConfig config;
    config.choice = livox::LidarChoice::kMid360;
    config.serial_number = serial_number;
    config.transport.bind_address = own_address(1);
    config.transport.points_port = config.transport.imu_port = 0;
    config.transport.control_port = config.transport.push_port = 0;
    driver_ =
        livox::LidarDriver::open(
            config, clock_,
            {[this](sensor::Measurement one) { take(std::move(one)); }, [](const livox::LidarEvent&) {}, {}})
            .value();
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) EXPECT_TRUE(driver_->step(stop));
      driver_->stop();
    });
  }
  void end() {
    thread_.request_stop();
    thread_.join();
    for (sync::MeasureGroup& group : builder_->flush()) groups_.push_back(std::move(group));
  }
  [[nodiscard]] const std::vector<sync::MeasureGroup>& groups() const { return groups_; }
  [[nodiscard]] const livox::LidarDriver& driver() const { return *driver_; }

 private:
  void take(sensor::Measurement one) {
    for (sync::MeasureGroup& group : builder_->push(std::move(one))) groups_.push_back(std::move(group));
  }
  SteadyClock clock_;
  std::unique_ptr<sync::GroupBuilder> builder_;
  std::vector<sync::MeasureGroup> groups_;
  std::unique_ptr<livox::LidarDriver> driver_;
  std::jthread thread_;
};

struct Played {
  HostTime began{};       ///< by the host's clock
  nanoseconds latest{0};  ///< of a packet after its last ray
};

/// As a Mid-360 does: a packet leaves after its last ray.
Played play(LidarDevice& device, const Clock& clock) {
  const auto begin = std::chrono::steady_clock::now();
  Played played{clock.now()};
  device.begin(host_time_from_ns(kRecorded_ns));
  std::int64_t next_sample_ns = 0;
  for (int k = 0; k < kPackets; ++k) {
    const std::int64_t first_ns = k * kPacket_ns;
    const auto due = begin + nanoseconds(first_ns + kSpan_ns);
    std::this_thread::sleep_until(due);
    played.latest = std::max<nanoseconds>(played.latest, std::chrono::steady_clock::now() - due);
    std::array<simulate::WirePoint, simulate::kPointsPerPacket> points{};
    for (std::size_t i = 0; i < points.size(); ++i)
      points.at(i) = {1000 + k, static_cast<std::int32_t>(i), 0, 10, 0};
    const SensorTime first = sensor_time_from_ns(kRecorded_ns + first_ns);
    device.points(
        simulate::encode_point_packet({static_cast<std::uint16_t>(k), first, nanoseconds(kSpan_ns)}, points),
        host_time_from_ns(to_ns(first)));
    for (; next_sample_ns <= first_ns + kSpan_ns; next_sample_ns += kSample_ns) {
      const auto number = static_cast<float>(next_sample_ns / kSample_ns);
      const SensorTime at = sensor_time_from_ns(kRecorded_ns + next_sample_ns);
      device.imu(simulate::encode_imu_packet({static_cast<std::uint16_t>(number), at, nanoseconds(0)},
                                             Eigen::Vector3f(number * 1e-3F, 0, 0), Eigen::Vector3f::UnitZ()),
                 host_time_from_ns(to_ns(at)));
    }
  }
  return played;
}

struct Outcome {
  Errors rays, samples;
  std::uint64_t lost = 0;
  nanoseconds latest{0};
};

Outcome drive_once(UnitSync sync) {
  const SteadyClock clock;
  LidarDeviceConfig config;
  config.unit.serial_number = "47MT" + std::to_string(1'000'000'000 + ::getpid());
  config.unit.clock.sync = sync;
  const auto ip = parse_address(own_address(10));
  config.unit.ip = *ip;
  auto device = LidarDevice::start(config, clock);
  if (!device) {
    ADD_FAILURE() << device.error().context;
    return {};
  }
  RobotGroups robot(config.unit.serial_number);
  EXPECT_TRUE((*device)->wait_for_host(20s, {}));
  const Played played = play(**device, clock);
  std::this_thread::sleep_for(300ms);
  robot.end();
  Outcome outcome;
  outcome.latest = played.latest;
  outcome.lost = robot.driver().source_counters().points.lost;
  // A disciplined clock shows the master's time, the recording's; else all is on the host's own.
  const std::int64_t zero_ns = sync == UnitSync::kPtp ? kRecorded_ns : to_ns(played.began);
  const auto warm_ns = zero_ns + static_cast<std::int64_t>(kWarmUp_s * 1e9);
  for (const sync::MeasureGroup& group : robot.groups()) {
    if (to_ns(group.begin) < warm_ns) continue;
    for (const sync::GroupPoint& point : group.points) {
      const auto packet = std::llround(1e3 * point.p_in_lidar_m.x()) - 1000;
      const auto ray = std::llround(1e3 * point.p_in_lidar_m.y());
      outcome.rays.add(group.end - nanoseconds(point.before_end_ns),
                       zero_ns + packet * kPacket_ns + ray * kRay_ns);
    }
    for (const sync::GroupImu& sample : group.imu)
      outcome.samples.add(sample.stamp, zero_ns + std::llround(1e3 * sample.gyro_radps.x()) * kSample_ns);
  }
  return outcome;
}

/// A machine that stood still sends nothing meanwhile and too much afterwards, as no LiDAR does: once more.
Outcome drive(UnitSync sync) {
  Outcome outcome = drive_once(sync);
  for (int again = 0; again < 3 && outcome.latest > kStandstill; ++again) outcome = drive_once(sync);
  return outcome;
}

void report(const char* what, Outcome& outcome) {
  for (auto& [name, errors] : {std::pair<const char*, Errors*>{"rays", &outcome.rays},
                               std::pair<const char*, Errors*>{"IMU samples", &outcome.samples}})
    std::printf("%s, %s: %zu, median %.1f us, 99 %% within %.1f us, worst %.1f us\n", what, name,
                errors->count(), errors->quantile(0.5), errors->quantile(0.99), errors->quantile(1.0));
  std::printf("%s: %llu packets lost; the latest left %.1f ms late\n", what,
              static_cast<unsigned long long>(outcome.lost), 1e3 * to_seconds(outcome.latest));
}

TEST(LidarTruth, WithPtpWithinTenMicroseconds) {
  Outcome outcome = drive(UnitSync::kPtp);
  report("PTP", outcome);
  EXPECT_GT(outcome.rays.count(), 4'000'000U);
  EXPECT_GT(outcome.samples.count(), 4'000U);
  EXPECT_LT(outcome.rays.quantile(0.99), 10.0);
  EXPECT_LT(outcome.samples.quantile(0.99), 10.0);
}

TEST(LidarTruth, RunningFreelyWithinAMillisecond) {
  Outcome outcome = drive(UnitSync::kNone);
  report("free", outcome);
  EXPECT_GT(outcome.rays.count(), 4'000'000U);
  EXPECT_GT(outcome.samples.count(), 4'000U);
  EXPECT_LT(outcome.rays.quantile(0.99), 1000.0);
  EXPECT_LT(outcome.samples.quantile(0.99), 1000.0);
}

}  // namespace
}  // namespace edgesplat::virtual_device
