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
#include <mutex>
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

/// The robot from its sockets to groups, a thread for each LiDAR. Each ray's x in mm is its packet's number
/// and its y its number in it; each sample's turning about x in mrad/s is its number.
class RobotGroups {
 public:
  explicit RobotGroups(const std::vector<std::string>& serial_numbers) {
    sensor::Rig rig;
    rig.imu.emplace();
    rig.more_lidars.resize(serial_numbers.size() - 1);
    builder_ = std::make_unique<sync::GroupBuilder>(sync::GroupBuilderConfig{}, rig);
    for (std::size_t unit = 0; unit < serial_numbers.size(); ++unit) {
      livox::LidarDriverConfig config;
      config.choice = livox::LidarChoice::kMid360;
      config.unit = static_cast<std::uint8_t>(unit);
      config.serial_number = serial_numbers[unit];
      config.neighbours = serial_numbers;
      config.has_imu = unit == 0;
      config.transport.bind_address = own_address(1);
      config.transport.points_port = config.transport.imu_port = 0;
      config.transport.control_port = config.transport.push_port = 0;
      drivers_.push_back(livox::LidarDriver::open(config, clock_,
                                                  {[this](sensor::Measurement one) { take(std::move(one)); },
                                                   [](const livox::LidarEvent&) {},
                                                   {}})
                             .value());
    }
    for (const auto& driver : drivers_) {
      threads_.emplace_back([&driver](const std::stop_token& stop) {
        while (!stop.stop_requested()) EXPECT_TRUE(driver->step(stop));
        driver->stop();
      });
    }
  }
  void end() {
    threads_.clear();
    for (sync::MeasureGroup& group : builder_->flush()) groups_.push_back(std::move(group));
  }
  [[nodiscard]] const std::vector<sync::MeasureGroup>& groups() const { return groups_; }
  [[nodiscard]] std::uint64_t lost() const {
    std::uint64_t lost = 0;
    for (const auto& driver : drivers_) lost += driver->source_counters().points.lost;
    return lost;
  }

 private:
  void take(sensor::Measurement one) {
    const std::lock_guard lock(mutex_);
    for (sync::MeasureGroup& group : builder_->push(std::move(one))) groups_.push_back(std::move(group));
  }
  SteadyClock clock_;
  std::mutex mutex_;  ///< builder_ and groups_, until end()
  std::unique_ptr<sync::GroupBuilder> builder_;
  std::vector<sync::MeasureGroup> groups_;
  std::vector<std::unique_ptr<livox::LidarDriver>> drivers_;
  std::vector<std::jthread> threads_;
};

using Devices = std::vector<std::unique_ptr<LidarDevice>>;

struct Played {
  HostTime began{};       ///< by the host's clock
  nanoseconds latest{0};  ///< of a packet after its last ray
};

/// As a Mid-360 does: a packet leaves after its last ray. All measure at the same times; the first has the
/// IMU.
Played play(const Devices& devices, const Clock& clock) {
  const auto begin = std::chrono::steady_clock::now();
  Played played{clock.now()};
  for (const auto& device : devices) device->begin(host_time_from_ns(kRecorded_ns));
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
    const auto packet =
        simulate::encode_point_packet({static_cast<std::uint16_t>(k), first, nanoseconds(kSpan_ns)}, points);
    for (const auto& device : devices) device->points(packet, host_time_from_ns(to_ns(first)));
    for (; next_sample_ns <= first_ns + kSpan_ns; next_sample_ns += kSample_ns) {
      const auto number = static_cast<float>(next_sample_ns / kSample_ns);
      const SensorTime at = sensor_time_from_ns(kRecorded_ns + next_sample_ns);
      devices.front()->imu(
          simulate::encode_imu_packet({static_cast<std::uint16_t>(number), at, nanoseconds(0)},
                                      Eigen::Vector3f(number * 1e-3F, 0, 0), Eigen::Vector3f::UnitZ()),
          host_time_from_ns(to_ns(at)));
    }
  }
  return played;
}

struct Outcome {
  std::array<Errors, 2> rays;  ///< of each LiDAR
  Errors samples;
  std::uint64_t lost = 0;
  nanoseconds latest{0};
};

Outcome drive_once(UnitSync sync, std::size_t lidars) {
  constexpr double kDrifts_ppm[] = {30.0, -45.0};
  const SteadyClock clock;
  Devices devices;
  std::vector<std::string> serial_numbers;
  for (std::size_t unit = 0; unit < lidars; ++unit) {
    LidarDeviceConfig config;
    config.unit.serial_number =
        "47MT" + std::to_string(1'000'000'000 + ::getpid() + 1'000'000 * static_cast<int>(unit));
    config.unit.clock.sync = sync;
    config.unit.clock.drift_ppm = kDrifts_ppm[unit];
    config.unit.clock.seed = 1 + unit;
    config.unit.ip = *parse_address(own_address(10 + static_cast<int>(unit)));
    auto device = LidarDevice::start(config, clock);
    if (!device) {
      ADD_FAILURE() << device.error().context;
      return {};
    }
    devices.push_back(*std::move(device));
    serial_numbers.push_back(config.unit.serial_number);
  }
  RobotGroups robot(serial_numbers);
  for (const auto& device : devices) EXPECT_TRUE(device->wait_for_host(20s, {}));
  const Played played = play(devices, clock);
  std::this_thread::sleep_for(300ms);
  robot.end();
  Outcome outcome;
  outcome.latest = played.latest;
  outcome.lost = robot.lost();
  // A disciplined clock shows the master's time, the recording's; else all is on the host's own.
  const std::int64_t zero_ns = sync == UnitSync::kPtp ? kRecorded_ns : to_ns(played.began);
  const auto warm_ns = zero_ns + static_cast<std::int64_t>(kWarmUp_s * 1e9);
  for (const sync::MeasureGroup& group : robot.groups()) {
    if (to_ns(group.begin) < warm_ns) continue;
    for (const sync::GroupPoint& point : group.points) {
      const auto packet = std::llround(1e3 * point.p_in_lidar_m.x()) - 1000;
      const auto ray = std::llround(1e3 * point.p_in_lidar_m.y());
      outcome.rays.at(point.unit)
          .add(group.end - nanoseconds(point.before_end_ns), zero_ns + packet * kPacket_ns + ray * kRay_ns);
    }
    for (const sync::GroupImu& sample : group.imu)
      outcome.samples.add(sample.stamp, zero_ns + std::llround(1e3 * sample.gyro_radps.x()) * kSample_ns);
  }
  return outcome;
}

/// A machine that stood still sends nothing meanwhile and too much afterwards, as no LiDAR does: once more.
Outcome drive(UnitSync sync, std::size_t lidars = 1) {
  Outcome outcome = drive_once(sync, lidars);
  for (int again = 0; again < 3 && outcome.latest > kStandstill; ++again) outcome = drive_once(sync, lidars);
  return outcome;
}

void report(const char* what, Outcome& outcome) {
  for (auto& [name, errors] : {std::pair<const char*, Errors*>{"rays", &outcome.rays[0]},
                               std::pair<const char*, Errors*>{"rays of the second", &outcome.rays[1]},
                               std::pair<const char*, Errors*>{"IMU samples", &outcome.samples}})
    std::printf("%s, %s: %zu, median %.1f us, 99 %% within %.1f us, worst %.1f us\n", what, name,
                errors->count(), errors->quantile(0.5), errors->quantile(0.99), errors->quantile(1.0));
  std::printf("%s: %llu packets lost; the latest left %.1f ms late\n", what,
              static_cast<unsigned long long>(outcome.lost), 1e3 * to_seconds(outcome.latest));
}

TEST(LidarTruth, WithPtpWithinTenMicroseconds) {
  Outcome outcome = drive(UnitSync::kPtp);
  report("PTP", outcome);
  EXPECT_GT(outcome.rays[0].count(), 4'000'000U);
  EXPECT_GT(outcome.samples.count(), 4'000U);
  EXPECT_LT(outcome.rays[0].quantile(0.99), 10.0);
  EXPECT_LT(outcome.samples.quantile(0.99), 10.0);
}

void expect_each_within(Outcome& outcome, double limit_us) {
  for (Errors& rays : outcome.rays) {
    EXPECT_GT(rays.count(), 4'000'000U);
    EXPECT_LT(rays.quantile(0.99), limit_us);
  }
  EXPECT_GT(outcome.samples.count(), 4'000U);
  EXPECT_LT(outcome.samples.quantile(0.99), limit_us);
}

TEST(LidarTruth, EachOfTwoWithPtpWithinTenMicroseconds) {
  Outcome outcome = drive(UnitSync::kPtp, 2);
  report("two, PTP", outcome);
  expect_each_within(outcome, 10.0);
}

TEST(LidarTruth, EachOfTwoRunningFreelyWithinAMillisecond) {
  Outcome outcome = drive(UnitSync::kNone, 2);
  report("two, free, +30 and -45 ppm", outcome);
  expect_each_within(outcome, 1000.0);
}

TEST(LidarTruth, RunningFreelyWithinAMillisecond) {
  Outcome outcome = drive(UnitSync::kNone);
  report("free", outcome);
  EXPECT_GT(outcome.rays[0].count(), 4'000'000U);
  EXPECT_GT(outcome.samples.count(), 4'000U);
  EXPECT_LT(outcome.rays[0].quantile(0.99), 1000.0);
  EXPECT_LT(outcome.samples.quantile(0.99), 1000.0);
}

}  // namespace
}  // namespace edgesplat::virtual_device
