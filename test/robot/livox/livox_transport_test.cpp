// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/livox_transport.hpp"

#include "common/base/unique_fd.hpp"
#include "robot/drivers/livox/port_holder.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace edgesplat::livox {
namespace {

using namespace std::chrono_literals;

LivoxTransportConfig loopback() {
  LivoxTransportConfig config;
  config.bind_address = "127.0.0.1";
  config.points_port = 0;
  config.imu_port = 0;
  return config;
}

void send_to(std::uint16_t port, std::size_t bytes, std::byte fill) {
  const UniqueFd fd(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const std::vector<std::byte> content(bytes, fill);
  ASSERT_EQ(::sendto(fd.get(), content.data(), content.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                     sizeof(to)),
            static_cast<ssize_t>(bytes));
}

/// The kernel turns on stamping some ms after the first socket asked for it; until then it stamps at reading.
/// True once a datagram that lay for 20 ms shows that it did.
bool stamps_are_on(LivoxTransport& transport, const Clock& clock) {
  const std::stop_source stop;
  for (int attempt = 0; attempt < 50; ++attempt) {
    send_to(transport.points_port(), 100, std::byte{0});
    const HostTime sent = clock.now();
    std::this_thread::sleep_for(20ms);
    const auto batch = transport.receive(stop.get_token(), 5s);
    if (batch && batch->size() == 1 && batch->front().arrival - sent < 10ms) return true;
  }
  return false;
}

TEST(LivoxTransport, ReceivesBothChannelsInOrderOfArrival) {
  const SteadyClock clock;
  auto transport = LivoxTransport::open(loopback(), clock);
  ASSERT_TRUE(transport.has_value()) << transport.error().context;
  ASSERT_TRUE(stamps_are_on(*transport, clock)) << "arrival is when it was read, not when the kernel got it";
  const std::uint64_t before_count = transport->counters().datagrams;
  EXPECT_GT(transport->receive_buffer_bytes(), 0);
  const HostTime before = clock.now();
  send_to(transport->imu_port(), 60, std::byte{1});
  send_to(transport->points_port(), 1380, std::byte{2});
  send_to(transport->imu_port(), 60, std::byte{3});
  const std::stop_source stop;
  std::vector<std::byte> order;
  while (order.size() < 3) {
    const auto batch = transport->receive(stop.get_token(), 5s);
    ASSERT_TRUE(batch.has_value()) << batch.error().context;
    ASSERT_FALSE(batch->empty());
    for (const Datagram& datagram : *batch) {
      order.push_back(datagram.bytes.front());
      EXPECT_EQ(datagram.channel, datagram.bytes.size() == 60 ? Channel::kImu : Channel::kPoints);
      EXPECT_GE(datagram.arrival, before - 1ms);
      EXPECT_LE(datagram.arrival, clock.now());
    }
  }
  EXPECT_EQ(order, (std::vector{std::byte{1}, std::byte{2}, std::byte{3}}));
  EXPECT_EQ(transport->counters().datagrams - before_count, 3U);
}

/// A thread that is held up for 4 ms before every third reading of its clock.
class HeldUpClock final : public Clock {
 public:
  [[nodiscard]] HostTime now() const override {
    if (++readings_ % 3 == 0) std::this_thread::sleep_for(4ms);
    return clock_.now();
  }

 private:
  SteadyClock clock_;
  mutable std::atomic<int> readings_{0};
};

/// A recording is replayed in the order of arrivals: one that is too late would pass its successors by.
TEST(LivoxTransport, ArrivalsNeverGoBackWhereTheThreadIsHeldUp) {
  const HeldUpClock clock;
  auto transport = LivoxTransport::open(loopback(), clock);
  ASSERT_TRUE(transport.has_value());
  ASSERT_TRUE(stamps_are_on(*transport, clock));
  const std::stop_source stop;
  std::jthread sender([port = transport->points_port()] {
    for (int i = 0; i < 200; ++i) {
      send_to(port, 100, std::byte{1});
      std::this_thread::sleep_for(500us);
    }
  });
  HostTime newest = HostTime::min();
  for (int received = 0; received < 200;) {
    const auto batch = transport->receive(stop.get_token(), 5s);
    ASSERT_TRUE(batch.has_value() && !batch->empty()) << "after " << received;
    for (const Datagram& datagram : *batch) {
      EXPECT_GE(datagram.arrival, newest) << "datagram " << received;
      newest = datagram.arrival;
      ++received;
    }
  }
}

TEST(LivoxTransport, StopAndTimeoutEndTheWait) {
  const SteadyClock clock;
  auto transport = LivoxTransport::open(loopback(), clock);
  ASSERT_TRUE(transport.has_value());
  std::stop_source stop;
  EXPECT_TRUE(transport->receive(stop.get_token(), 1ms)->empty());
  std::jthread stopper([&stop] {
    std::this_thread::sleep_for(20ms);
    stop.request_stop();
  });
  const HostTime begin = clock.now();
  EXPECT_TRUE(transport->receive(stop.get_token(), 30s)->empty());
  EXPECT_LT(clock.now() - begin, 10s);
}

TEST(LivoxTransport, DropsDatagramsOfOtherSenders) {
  const SteadyClock clock;
  LivoxTransportConfig config = loopback();
  config.lidar_address = "127.0.0.9";
  auto transport = LivoxTransport::open(config, clock);
  ASSERT_TRUE(transport.has_value());
  send_to(transport->points_port(), 100, std::byte{1});
  const std::stop_source stop;
  EXPECT_TRUE(transport->receive(stop.get_token(), 5s)->empty());
  EXPECT_EQ(transport->counters().foreign, 1U);
}

TEST(LivoxTransport, ATakenPortNamesItsHolder) {
  const SteadyClock clock;
  auto first = LivoxTransport::open(loopback(), clock);
  ASSERT_TRUE(first.has_value());
  LivoxTransportConfig config = loopback();
  config.points_port = first->points_port();
  const auto second = LivoxTransport::open(config, clock);
  ASSERT_FALSE(second.has_value());
  EXPECT_EQ(second.error().code, Errc::kIo);
  EXPECT_NE(second.error().context.find(std::to_string(config.points_port)), std::string::npos);
  EXPECT_NE(second.error().context.find("pid " + std::to_string(::getpid())), std::string::npos)
      << second.error().context;
  EXPECT_NE(second.error().context.find("test_robot_liv"), std::string::npos) << second.error().context;
}

TEST(LivoxTransport, RefusesAddressesThatAreNone) {
  const SteadyClock clock;
  LivoxTransportConfig config = loopback();
  config.bind_address = "lidar.local";
  EXPECT_EQ(LivoxTransport::open(config, clock).error().code, Errc::kInvalidConfig);
  config = loopback();
  config.bind_address = "203.0.113.77";  // nobody's card has this one (RFC 5737)
  EXPECT_EQ(LivoxTransport::open(config, clock).error().code, Errc::kIo);
  config = loopback();
  config.points_port = config.imu_port = 56301;
  EXPECT_EQ(LivoxTransport::open(config, clock).error().code, Errc::kInvalidConfig);
}

TEST(PortHolder, ReadsTheKernelsTable) {
  const std::string table =
      "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode ref\n"
      "  12: 0100007F:DBED 00000000:0000 07 00000000:00000000 00:00000000 00000000  1000        0 4711 2 0 "
      "0\n"
      "  13: 00000000:DC51 00000000:0000 07 00000000:00000000 00:00000000 00000000  1000        0 4712 2 0 "
      "0\n"
      "  14: broken\n";
  EXPECT_EQ(inodes_of_port(table, 56301), std::vector<std::string>{"4711"});
  EXPECT_EQ(inodes_of_port(table, 56401), std::vector<std::string>{"4712"});
  EXPECT_TRUE(inodes_of_port(table, 1).empty());
}

}  // namespace
}  // namespace edgesplat::livox
