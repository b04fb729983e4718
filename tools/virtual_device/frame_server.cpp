// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/frame_server.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

namespace edgesplat::virtual_device {
namespace {

constexpr std::size_t kWaitingFrames = 8;
constexpr int kStopCheck_ms = 100;
constexpr timeval kSendTimeout{2, 0};  // a robot that reads nothing this long is gone

bool send_all(int fd, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

std::string reason(const std::string& what, std::uint16_t port) {
  return what + " TCP port " + std::to_string(port) + ": " + std::strerror(errno);
}

}  // namespace

Result<std::unique_ptr<FrameServer>> FrameServer::listen(std::uint16_t port) {
  UniqueFd listener(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!listener.valid()) return fail(Errc::kIo, reason("cannot open a socket for", port));
  const int yes = 1;
  (void)::setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(port);
  at.sin_addr.s_addr = htonl(INADDR_ANY);
  if (::bind(listener.get(), reinterpret_cast<const sockaddr*>(&at), sizeof(at)) != 0 ||
      ::listen(listener.get(), 1) != 0) {
    return fail(Errc::kIo, reason("cannot serve frames on", port));
  }
  socklen_t size = sizeof(at);
  if (::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&at), &size) != 0) {
    return fail(Errc::kIo, reason("cannot ask for", port));
  }
  return std::unique_ptr<FrameServer>(new FrameServer(std::move(listener), ntohs(at.sin_port)));
}

FrameServer::FrameServer(UniqueFd listener, std::uint16_t port)
    : listener_(std::move(listener)),
      port_(port),
      queue_({.items = kWaitingFrames}, thread::Overflow::kDropOldest) {}

FrameServer::~FrameServer() {
  finish();
}

bool FrameServer::accept_robot(int timeout_ms) {
  pollfd waiting{listener_.get(), POLLIN, 0};
  if (::poll(&waiting, 1, timeout_ms) <= 0) return false;
  UniqueFd robot(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
  if (!robot.valid()) return false;
  const int yes = 1;
  (void)::setsockopt(robot.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
  (void)::setsockopt(robot.get(), SOL_SOCKET, SO_SNDTIMEO, &kSendTimeout, sizeof(kSendTimeout));
  robot_ = std::move(robot);
  return true;
}

bool FrameServer::wait_for_robot(std::chrono::milliseconds timeout, const std::stop_token& stop) {
  auto left_ms = static_cast<int>(timeout.count());
  while (left_ms > 0 && !stop.stop_requested()) {
    const int slice_ms = std::min(left_ms, kStopCheck_ms);
    if (accept_robot(slice_ms)) return true;
    left_ms -= slice_ms;
  }
  return false;
}

void FrameServer::push(const FrameMessage& message, std::vector<std::byte> payload) {
  if (!worker_) {
    worker_.emplace(
        thread::Worker::consume<Frame>("frame-server", queue_, [this](const Frame& frame) { serve(frame); }));
  }
  queue_.push({message, std::move(payload)});
}

void FrameServer::serve(const Frame& frame) {
  if (!robot_.valid() && !accept_robot(0)) {
    ++lost_;
    return;
  }
  const auto header = encode_frame_header(frame.message, frame.payload);
  if (send_all(robot_.get(), header) && send_all(robot_.get(), frame.payload)) {
    ++sent_;
  } else {
    robot_.reset();
    ++lost_;
  }
}

void FrameServer::finish() {
  queue_.close();
  if (worker_) worker_->join();
  robot_.reset();
}

}  // namespace edgesplat::virtual_device
