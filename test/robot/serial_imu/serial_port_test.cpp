// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The line is a pseudo-terminal, whose other end is the sensor.
#include "robot/drivers/serial_imu/serial_port.hpp"

#include "robot/drivers/serial_imu/serial_source.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

namespace edgesplat::serial_imu {
namespace {

using namespace std::chrono_literals;

/// A sensor behind a path that stays the same when it is plugged in again.
class Sensor {
 public:
  Sensor()
      : link_(std::filesystem::temp_directory_path() / ("edgesplat-serial-" + std::to_string(::getpid()))) {}
  ~Sensor() { unplug(); }
  void plug() {
    master_.reset(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC));
    ASSERT_EQ(::grantpt(master_.get()), 0);
    ASSERT_EQ(::unlockpt(master_.get()), 0);
    std::filesystem::create_symlink(::ptsname(master_.get()), link_);
  }
  void unplug() {
    std::filesystem::remove(link_);
    master_.reset();
  }
  void send(std::span<const std::byte> bytes) {
    ASSERT_EQ(::write(master_.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  [[nodiscard]] std::string path() const { return link_; }

 private:
  std::filesystem::path link_;
  UniqueFd master_;
};

InertialFrame sample(std::uint16_t k) {
  // Bytes that a terminal would take for line ends, interrupts and flow control if it were not raw.
  return {k, sensor_time_from_ns(0x0A0D'0311'1300'0000LL + k), {1.0F, 2.0F, 3.0F}, {0.0F, 0.0F, 9.81F}};
}

class SerialPortTest : public testing::Test {
 protected:
  SerialPort open() {
    return SerialPort::create({.path = sensor_.path(), .silence_s = 0.3, .retry_s = 0.05}, clock_).value();
  }
  /// Receives until `count` samples came or the time is over.
  int receive(SerialPort& port, int count, nanoseconds limit) {
    int got = 0;
    const HostTime until = clock_.now() + limit;
    while (got < count && clock_.now() < until) {
      const auto read = port.receive({}, 20ms);
      if (read.first) decoder_.restart();
      decoder_.append(read.bytes);
      while (const auto frame = decoder_.next())
        if (source_.on_frame(std::get<InertialFrame>(*frame), read.arrival)) ++got;
    }
    return got;
  }
  SteadyClock clock_;
  Sensor sensor_;
  FrameDecoder decoder_;
  SerialSource source_;
};

TEST_F(SerialPortTest, EveryByteComesThroughRaw) {
  sensor_.plug();
  auto port = open();
  (void)port.receive({}, 10ms);  // opens
  ASSERT_TRUE(port.connected());
  std::jthread sending([&] {
    for (std::uint16_t k = 0; k < 500; ++k) sensor_.send(encode(sample(k)));
  });
  EXPECT_EQ(receive(port, 500, 5s), 500);
  EXPECT_EQ(source_.counters().lost, 0U);
  EXPECT_EQ(decoder_.counters().bytes_skipped, 0U);
}

TEST_F(SerialPortTest, ASensorThatIsUnpluggedComesBack) {
  auto port = open();
  EXPECT_TRUE(port.receive({}, 60ms).bytes.empty());
  EXPECT_FALSE(port.connected());
  sensor_.plug();
  std::uint16_t k = 0;
  const auto send_some = [&] {
    for (int i = 0; i < 20; ++i) sensor_.send(encode(sample(k++)));
  };
  ASSERT_TRUE([&] {
    for (int i = 0; i < 100 && !port.connected(); ++i) (void)port.receive({}, 10ms);
    return port.connected();
  }());
  send_some();
  EXPECT_EQ(receive(port, 20, 2s), 20);
  sensor_.unplug();
  const HostTime gone = clock_.now();
  while (port.connected() && clock_.now() - gone < 2s) (void)port.receive({}, 20ms);
  EXPECT_LT(clock_.now() - gone, 1s);
  EXPECT_EQ(port.counters().losses, 1U);
  sensor_.plug();
  const HostTime back = clock_.now();
  while (!port.connected() && clock_.now() - back < 3s) (void)port.receive({}, 20ms);
  send_some();
  EXPECT_EQ(receive(port, 20, 2s), 20);
  EXPECT_LT(clock_.now() - back, 3s);
}

TEST_F(SerialPortTest, SilenceIsALoss) {
  sensor_.plug();
  auto port = open();
  testing::internal::CaptureStderr();
  const HostTime begin = clock_.now();
  while (port.counters().losses == 0 && clock_.now() - begin < 2s) (void)port.receive({}, 20ms);
  EXPECT_LT(clock_.now() - begin, 1s);
  for (int i = 0; i < 40; ++i) (void)port.receive({}, 20ms);  // it stays silent
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_NE(log.find("silent"), std::string::npos) << log;
  EXPECT_EQ(std::ranges::count(log, '\n'), 1) << log;
}

TEST_F(SerialPortTest, AFileIsNoLineAndRatesAreChecked) {
  auto file = SerialPort::create({.path = "/dev/null"}, clock_);
  ASSERT_TRUE(file.has_value());
  (void)file->receive({}, 10ms);
  EXPECT_FALSE(file->connected());
  EXPECT_EQ(file->counters().failed_opens, 1U);
  EXPECT_FALSE(SerialPort::create({.path = "/dev/ttyUSB0", .baud = 12345}, clock_).has_value());
  EXPECT_FALSE(SerialPort::create({.path = ""}, clock_).has_value());
}

TEST_F(SerialPortTest, AStopEndsTheWaiting) {
  auto port = open();
  std::stop_source stop;
  std::jthread stopping([&] { stop.request_stop(); });
  const HostTime begin = clock_.now();
  EXPECT_TRUE(port.receive(stop.get_token(), 10s).bytes.empty());
  EXPECT_LT(clock_.now() - begin, 5s);
}

}  // namespace
}  // namespace edgesplat::serial_imu
