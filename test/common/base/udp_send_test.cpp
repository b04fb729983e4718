// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/udp_send.hpp"

#include "common/base/unique_fd.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>

namespace edgesplat {
namespace {

sockaddr_in loopback(std::uint32_t address, std::uint16_t port) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_addr.s_addr = htonl(address);
  out.sin_port = port;
  return out;
}

class SendDatagram : public testing::Test {
 protected:
  SendDatagram() {
    sockaddr_in at = loopback(INADDR_LOOPBACK, 0);
    EXPECT_EQ(::bind(receiver_.get(), reinterpret_cast<const sockaddr*>(&at), sizeof(at)), 0);
    socklen_t length = sizeof(to_);
    EXPECT_EQ(::getsockname(receiver_.get(), reinterpret_cast<sockaddr*>(&to_), &length), 0);
  }
  /// The address that a datagram came from; its bytes must be those of `sent`.
  std::uint32_t sender_of(std::span<const std::byte> sent) const {
    std::array<std::byte, 16> bytes{};
    sockaddr_in from{};
    socklen_t length = sizeof(from);
    const ssize_t count = ::recvfrom(receiver_.get(), bytes.data(), bytes.size(), 0,
                                     reinterpret_cast<sockaddr*>(&from), &length);
    EXPECT_EQ(count, static_cast<ssize_t>(sent.size()));
    EXPECT_TRUE(std::equal(sent.begin(), sent.end(), bytes.begin()));
    return ntohl(from.sin_addr.s_addr);
  }

  UniqueFd receiver_{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  UniqueFd sender_{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  sockaddr_in to_{};
};

TEST_F(SendDatagram, GoesFromTheAddressAskedForOrAsTheRouteSays) {
  const std::array bytes{std::byte{1}, std::byte{2}, std::byte{3}};
  const std::uint32_t third = INADDR_LOOPBACK + 2;
  EXPECT_TRUE(send_datagram(sender_.get(), to_, {htonl(third)}, bytes));
  EXPECT_EQ(sender_of(bytes), third);
  EXPECT_TRUE(send_datagram(sender_.get(), to_, {htonl(INADDR_ANY)}, bytes));
  EXPECT_EQ(sender_of(bytes), INADDR_LOOPBACK);
}

TEST_F(SendDatagram, SaysWhereItCannot) {
  EXPECT_FALSE(send_datagram(-1, to_, {htonl(INADDR_ANY)}, {}));
  const std::array bytes{std::byte{1}};
  EXPECT_FALSE(send_datagram(sender_.get(), to_, {htonl(0xCB007107)}, bytes)) << "203.0.113.7 is not ours";
}

}  // namespace
}  // namespace edgesplat
