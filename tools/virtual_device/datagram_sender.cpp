// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/datagram_sender.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

namespace edgesplat::virtual_device {

Result<DatagramSender> DatagramSender::open(const std::string& address, std::uint16_t port) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  if (::inet_pton(AF_INET, address.c_str(), &to.sin_addr) != 1) {
    return fail(Errc::kInvalidConfig, "'" + address + "' is no IPv4 address; give it as 127.0.0.1");
  }
  UniqueFd socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!socket.valid())
    return fail(Errc::kIo, std::string("cannot open a UDP socket: ") + std::strerror(errno));
  return DatagramSender(std::move(socket), to);
}

bool DatagramSender::send(std::span<const std::byte> datagram) {
  // Not connected: a connected socket would lose every other datagram to "port unreachable" until the robot
  // is up.
  const ssize_t n = ::sendto(socket_.get(), datagram.data(), datagram.size(), MSG_NOSIGNAL,
                             reinterpret_cast<const sockaddr*>(&to_), sizeof(to_));
  const bool whole = n >= 0 && static_cast<std::size_t>(n) == datagram.size();
  ++(whole ? sent_ : refused_);
  return whole;
}

}  // namespace edgesplat::virtual_device
