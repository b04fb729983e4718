// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/gvcp_probe.hpp"

#include "common/thread/stop_fd.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>

namespace edgesplat::aravis {
namespace {

constexpr std::uint16_t kGvcpPort = 3956;
constexpr std::size_t kAnswerBytes = 8 + 0xF8;

}  // namespace

bool is_discovery_answer(std::span<const std::byte> datagram) {
  // Status 0, code 3, 0xF8 bytes, id 1.
  constexpr std::array<std::byte, 8> kHeader{std::byte{0x00}, std::byte{0x00}, std::byte{0x00},
                                             std::byte{0x03}, std::byte{0x00}, std::byte{0xF8},
                                             std::byte{0x00}, std::byte{0x01}};
  return datagram.size() == kAnswerBytes && std::equal(kHeader.begin(), kHeader.end(), datagram.begin());
}

GvcpProbe::GvcpProbe(const std::string& address) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(kGvcpPort);
  if (::inet_pton(AF_INET, address.c_str(), &to.sin_addr) != 1) return;
  UniqueFd socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (socket.valid() && ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&to), sizeof(to)) == 0)
    socket_ = std::move(socket);
}

bool GvcpProbe::answers(const std::stop_token& stop, nanoseconds timeout) const {
  if (!socket_.valid()) return false;
  std::array<std::byte, 1024> datagram{};
  // An answer that came too late is none to this question.
  while (::recv(socket_.get(), datagram.data(), datagram.size(), 0) > 0) {
  }
  if (::send(socket_.get(), kDiscoveryCommand.data(), kDiscoveryCommand.size(), MSG_NOSIGNAL) < 0)
    return false;
  const thread::StopFd stop_fd(stop);
  std::array<pollfd, 2> fds{pollfd{stop_fd.get(), POLLIN, 0}, pollfd{socket_.get(), POLLIN, 0}};
  const auto wait_ms = std::chrono::ceil<std::chrono::milliseconds>(timeout).count();
  if (::poll(fds.data(), fds.size(), static_cast<int>(wait_ms)) <= 0 || fds[0].revents != 0) return false;
  const ssize_t bytes = ::recv(socket_.get(), datagram.data(), datagram.size(), 0);
  return bytes > 0 && is_discovery_answer(std::span(datagram).first(static_cast<std::size_t>(bytes)));
}

}  // namespace edgesplat::aravis
