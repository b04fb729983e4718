// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/gvcp_finder.hpp"

#include "common/base/local_address.hpp"
#include "common/base/udp_send.hpp"
#include "common/thread/stop_fd.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <chrono>

namespace edgesplat::aravis {
namespace {

constexpr std::uint16_t kGvcpPort = 3956;
constexpr std::size_t kHeaderBytes = 8;
constexpr std::size_t kAnswerBytes = kHeaderBytes + 0xF8;
// Places in the bootstrap registers.
constexpr std::size_t kMac = 0x0A, kAddress = 0x24, kMaker = 0x48, kSerialNumber = 0xD8;
constexpr std::size_t kMakerBytes = 32, kSerialNumberBytes = 16;

/// Up to the first zero; what is not printable would spoil a line of the log.
std::string text_at(std::span<const std::byte> registers, std::size_t at, std::size_t most_bytes) {
  std::string text;
  for (const std::byte byte : registers.subspan(at, most_bytes)) {
    const char letter = static_cast<char>(byte);
    if (letter == '\0') break;
    text += letter >= ' ' && letter <= '~' ? letter : '?';
  }
  return text;
}

bool send_to(int socket, in_addr to, in_addr source, std::span<const std::byte> bytes) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(kGvcpPort);
  address.sin_addr = to;
  return send_datagram(socket, address, source, bytes);
}

}  // namespace

bool is_same_camera(const FoundCamera& a, const FoundCamera& b) {
  if (a.serial_number.empty() || b.serial_number.empty()) return a.mac == b.mac;
  return a.serial_number == b.serial_number && a.maker == b.maker;
}

std::array<std::byte, 8> discovery_command(std::uint16_t id) {
  // A command; an answer is wanted, a broadcast one too (0x10): a camera with an address of another network
  // has no other way. Code 2, no payload.
  return {std::byte{0x42},
          std::byte{0x11},
          std::byte{0x00},
          std::byte{0x02},
          std::byte{0x00},
          std::byte{0x00},
          static_cast<std::byte>(id >> 8U),
          static_cast<std::byte>(id & 0xFFU)};
}

std::optional<FoundCamera> read_discovery_answer(std::span<const std::byte> datagram, std::uint16_t id) {
  // Status 0, code 3, 0xF8 bytes.
  const std::array<std::byte, kHeaderBytes> header{std::byte{0x00},
                                                   std::byte{0x00},
                                                   std::byte{0x00},
                                                   std::byte{0x03},
                                                   std::byte{0x00},
                                                   std::byte{0xF8},
                                                   static_cast<std::byte>(id >> 8U),
                                                   static_cast<std::byte>(id & 0xFFU)};
  if (datagram.size() != kAnswerBytes || !std::equal(header.begin(), header.end(), datagram.begin()))
    return std::nullopt;
  const auto registers = datagram.subspan(kHeaderBytes);
  FoundCamera camera;
  for (std::size_t i = 0; i < 6; ++i)
    camera.mac = (camera.mac << 8U) | std::to_integer<std::uint64_t>(registers[kMac + i]);
  std::array<char, INET_ADDRSTRLEN> address{};
  if (::inet_ntop(AF_INET, registers.data() + kAddress, address.data(), address.size()) == nullptr)
    return std::nullopt;
  camera.address = address.data();
  camera.maker = text_at(registers, kMaker, kMakerBytes);
  camera.serial_number = text_at(registers, kSerialNumber, kSerialNumberBytes);
  return camera;
}

GvcpFinder::GvcpFinder() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  const int on = 1;
  if (socket_.valid()) (void)::setsockopt(socket_.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof(on));
}

std::array<std::byte, 8> GvcpFinder::next_question() {
  if (++id_ == 0) ++id_;  // 0 is no id
  return discovery_command(id_);
}

std::optional<FoundCamera> GvcpFinder::ask(const std::string& address, const std::stop_token& stop,
                                           nanoseconds timeout) {
  in_addr to{};
  if (::inet_pton(AF_INET, address.c_str(), &to) != 1) return std::nullopt;
  if (!send_to(socket_.get(), to, in_addr{}, next_question())) return std::nullopt;
  auto camera = wait([](const FoundCamera&) { return true; }, stop, timeout);
  if (camera) camera->address = address;
  return camera;
}

std::optional<FoundCamera> GvcpFinder::find(const Wanted& wanted, const std::stop_token& stop,
                                            nanoseconds timeout) {
  in_addr everyone{};
  everyone.s_addr = htonl(INADDR_BROADCAST);
  auto sources = broadcast_sources();
  sources.push_back({htonl(INADDR_LOOPBACK)});  // virtual cameras
  const auto question = next_question();
  bool sent = false;
  for (const in_addr source : sources) sent = send_to(socket_.get(), everyone, source, question) || sent;
  return sent ? wait(wanted, stop, timeout) : std::nullopt;
}

std::optional<FoundCamera> GvcpFinder::wait(const Wanted& wanted, const std::stop_token& stop,
                                            nanoseconds timeout) {
  const thread::StopFd stop_fd(stop);
  const auto until = std::chrono::steady_clock::now() + timeout;
  std::array<std::byte, 1024> datagram{};
  for (bool first = true;; first = false) {
    const auto left = std::max<nanoseconds>(until - std::chrono::steady_clock::now(), nanoseconds(0));
    if (left == nanoseconds(0) && !first) return std::nullopt;
    const auto wait_ms = std::chrono::ceil<std::chrono::milliseconds>(left).count();
    std::array<pollfd, 2> fds{pollfd{stop_fd.get(), POLLIN, 0}, pollfd{socket_.get(), POLLIN, 0}};
    if (::poll(fds.data(), fds.size(), static_cast<int>(wait_ms)) <= 0 || fds[0].revents != 0)
      return std::nullopt;
    const ssize_t bytes = ::recv(socket_.get(), datagram.data(), datagram.size(), 0);
    if (bytes < 0) continue;  // somebody refused the question
    auto camera = read_discovery_answer(std::span(datagram).first(static_cast<std::size_t>(bytes)), id_);
    if (camera && wanted(*camera)) return camera;
  }
}

}  // namespace edgesplat::aravis
