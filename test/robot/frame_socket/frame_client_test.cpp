// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/frame_socket/frame_client.hpp"

#include "test/robot/frame_socket/frame_bytes.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <chrono>
#include <thread>

namespace edgesplat::frame_socket {
namespace {

using namespace std::chrono_literals;

/// A camera on an ephemeral port of the loopback.
class Listener {
 public:
  explicit Listener(std::uint16_t port = 0) : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const int on = 1;
    (void)::setsockopt(fd_.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    sockaddr_in local{};
    local.sin_family = AF_INET;
    local.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    local.sin_port = htons(port);
    EXPECT_EQ(::bind(fd_.get(), reinterpret_cast<const sockaddr*>(&local), sizeof(local)), 0);
    EXPECT_EQ(::listen(fd_.get(), 4), 0);
    socklen_t length = sizeof(local);
    EXPECT_EQ(::getsockname(fd_.get(), reinterpret_cast<sockaddr*>(&local), &length), 0);
    port_ = ntohs(local.sin_port);
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] UniqueFd accept() const { return UniqueFd(::accept(fd_.get(), nullptr, nullptr)); }

 private:
  UniqueFd fd_;
  std::uint16_t port_ = 0;
};

void send_all(const UniqueFd& fd, std::span<const std::byte> bytes) {
  ASSERT_EQ(::send(fd.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
}

std::vector<std::byte> message(std::uint32_t sequence) {
  MessageFields fields;
  fields.sequence = sequence;
  const std::vector<std::byte> payload(1000, std::byte{7});
  return message_bytes(fields, payload);
}

FrameClient client_of(std::uint16_t port, const Clock& clock) {
  FrameClientConfig config;
  config.port = port;
  config.first_retry_s = 0.01;
  config.longest_retry_s = 0.05;
  return FrameClient::create(config, clock).value();
}

TEST(FrameClient, ReceivesFramesAndTheirArrival) {
  const SteadyClock clock;
  const Listener camera;
  FrameClient client = client_of(camera.port(), clock);
  std::stop_source stop;
  EXPECT_FALSE(client.receive(stop.get_token(), 20ms).has_value());  // connects meanwhile
  const UniqueFd connection = camera.accept();
  const auto bytes = message(4);
  send_all(connection, std::span(bytes).first(500));
  const HostTime first_half = clock.now();
  EXPECT_FALSE(client.receive(stop.get_token(), 20ms).has_value());
  send_all(connection, std::span(bytes).subspan(500));
  const auto got = client.receive(stop.get_token(), 5s);
  ASSERT_TRUE(got.has_value());
  EXPECT_EQ(got->frame.header.sequence, 4U);
  EXPECT_EQ(got->frame.payload.size(), 1000U);
  EXPECT_GT(got->arrival, first_half);
  EXPECT_TRUE(client.connected());
  EXPECT_TRUE(client.why_not_connected().empty());
}

TEST(FrameClient, ComesBackAfterTheCameraWasGone) {
  const SteadyClock clock;
  auto camera = std::make_unique<Listener>();
  const std::uint16_t port = camera->port();
  FrameClient client = client_of(port, clock);
  std::stop_source stop;
  (void)client.receive(stop.get_token(), 20ms);
  {
    const UniqueFd connection = camera->accept();
    const auto bytes = message(1);
    send_all(connection, std::span(bytes).first(300));  // dies within a message
  }
  camera.reset();
  EXPECT_FALSE(client.receive(stop.get_token(), 100ms).has_value());
  EXPECT_FALSE(client.connected());
  EXPECT_GE(client.counters().failed_attempts, 1U);
  EXPECT_NE(client.why_not_connected().find("127.0.0.1:" + std::to_string(port)), std::string::npos)
      << client.why_not_connected();

  const Listener again(port);
  std::jthread sender([&again] {
    const UniqueFd connection = again.accept();
    send_all(connection, message(2));
    std::this_thread::sleep_for(200ms);
  });
  const auto got = client.receive(stop.get_token(), 10s);
  ASSERT_TRUE(got.has_value());
  EXPECT_EQ(got->frame.header.sequence, 2U);
  EXPECT_EQ(client.counters().connects, 2U);
  EXPECT_EQ(client.counters().disconnects, 1U);
}

TEST(FrameClient, StopEndsTheWait) {
  const SteadyClock clock;
  const Listener camera;
  FrameClient client = client_of(camera.port(), clock);
  std::stop_source stop;
  std::jthread stopper([&stop] {
    std::this_thread::sleep_for(20ms);
    stop.request_stop();
  });
  const HostTime begin = clock.now();
  EXPECT_FALSE(client.receive(stop.get_token(), 30s).has_value());
  EXPECT_LT(clock.now() - begin, 10s);
}

TEST(FrameClient, RefusesAnAddressThatIsNone) {
  const SteadyClock clock;
  FrameClientConfig config;
  config.port = 0;
  EXPECT_EQ(FrameClient::create(config, clock).error().code, Errc::kInvalidConfig);
}

}  // namespace
}  // namespace edgesplat::frame_socket
