// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/unique_fd.hpp"

#include <netinet/in.h>
#include <sys/socket.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

namespace edgesplat::virtual_device {

inline sockaddr_in loopback_address(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// A UDP socket on a free port, as the robot has one. Reads time out after 2 s.
class UdpListener {
 public:
  UdpListener() : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in address = loopback_address(0);
    const int size_bytes = 4 << 20;
    const timeval timeout{2, 0};
    (void)::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUF, &size_bytes, sizeof(size_bytes));
    (void)::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof(timeout));
    (void)::bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof(address));
    socklen_t size = sizeof(address);
    (void)::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// The next datagram, empty when none comes.
  std::vector<std::byte> receive() {
    std::vector<std::byte> datagram(2000);
    const ssize_t n = ::recv(socket_.get(), datagram.data(), datagram.size(), 0);
    datagram.resize(n < 0 ? 0 : static_cast<std::size_t>(n));
    return datagram;
  }

 private:
  UniqueFd socket_;
  std::uint16_t port_ = 0;
};

/// The robot's end of the frame socket: tries to connect for 5 s.
inline UniqueFd connect_to(std::uint16_t port) {
  const sockaddr_in address = loopback_address(port);
  for (int attempt = 0; attempt < 100; ++attempt) {
    UniqueFd socket(::socket(AF_INET, SOCK_STREAM, 0));
    const timeval timeout{5, 0};
    (void)::setsockopt(socket.get(), SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof(timeout));
    if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0)
      return socket;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return {};
}

/// Exactly `count` bytes, or fewer at the end of the connection.
inline std::vector<std::byte> read_bytes(int fd, std::size_t count) {
  std::vector<std::byte> bytes(count);
  std::size_t got = 0;
  while (got < count) {
    const ssize_t n = ::recv(fd, bytes.data() + got, count - got, 0);
    if (n <= 0) break;
    got += static_cast<std::size_t>(n);
  }
  bytes.resize(got);
  return bytes;
}

}  // namespace edgesplat::virtual_device
