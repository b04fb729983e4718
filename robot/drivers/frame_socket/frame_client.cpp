// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/frame_socket/frame_client.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <memory>
#include <system_error>
#include <utility>

namespace edgesplat::frame_socket {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{256} << 10U;

std::string system_text(int error) {
  return std::generic_category().message(error);
}

void set_option(int fd, int level, int option, int value) {
  (void)::setsockopt(fd, level, option, &value, sizeof(value));
}

/// A cable that is pulled shows after about 5 s.
void watch_connection(int fd) {
  set_option(fd, SOL_SOCKET, SO_KEEPALIVE, 1);
  set_option(fd, IPPROTO_TCP, TCP_KEEPIDLE, 2);
  set_option(fd, IPPROTO_TCP, TCP_KEEPINTVL, 1);
  set_option(fd, IPPROTO_TCP, TCP_KEEPCNT, 3);
}

}  // namespace

Result<FrameClient> FrameClient::create(FrameClientConfig config, const Clock& clock) {
  if (config.host.empty() || config.port == 0)
    return fail(Errc::kInvalidConfig, "the camera needs a host and a port from 1 to 65535, got '" +
                                          config.host + "' and " + std::to_string(config.port));
  config.first_retry_s = std::clamp(config.first_retry_s, 0.001, 60.0);
  config.longest_retry_s = std::clamp(config.longest_retry_s, config.first_retry_s, 600.0);
  return FrameClient(std::move(config), clock);
}

FrameClient::FrameClient(FrameClientConfig config, const Clock& clock)
    : config_(std::move(config)), clock_(&clock), chunk_(kChunkBytes), retry_s_(config_.first_retry_s) {}

std::int64_t FrameClient::steady_ns() {
  return to_ns(SteadyClock().now());
}

std::string FrameClient::peer() const {
  return config_.host + ":" + std::to_string(config_.port);
}

std::optional<ReceivedFrame> FrameClient::receive(const std::stop_token& stop, nanoseconds timeout) {
  if (!stop_fd_ || !stop_fd_->listens_to(stop)) stop_fd_ = std::make_unique<thread::StopFd>(stop);
  const std::int64_t until_ns = steady_ns() + timeout.count();
  while (true) {
    if (auto frame = assembler_.next()) return ReceivedFrame{*std::move(frame), last_read_};
    if (stop.stop_requested()) return std::nullopt;
    if (state_ == State::kWaiting && steady_ns() >= retry_at_ns_) start_connecting();
    if (!wait(until_ns)) return std::nullopt;
  }
}

bool FrameClient::wait(std::int64_t until_ns) {
  const std::int64_t now_ns = steady_ns();
  if (now_ns >= until_ns) return false;
  const std::int64_t next_ns = state_ == State::kWaiting ? std::min(until_ns, retry_at_ns_) : until_ns;
  const std::int64_t wait_ms = std::max<std::int64_t>(0, (next_ns - now_ns + 999'999) / 1'000'000);
  const short events = state_ == State::kConnecting ? POLLOUT : POLLIN;
  std::array<pollfd, 2> fds{pollfd{stop_fd_->get(), POLLIN, 0},
                            pollfd{state_ == State::kWaiting ? -1 : socket_.get(), events, 0}};
  const int ready =
      ::poll(fds.data(), fds.size(),
             static_cast<int>(std::min<std::int64_t>(wait_ms, std::numeric_limits<int>::max())));
  if (ready <= 0) return true;  // the time is over, or a signal came: the caller looks at its clock
  if (fds[0].revents != 0) return false;
  if (fds[1].revents != 0) {
    if (state_ == State::kConnecting) {
      finish_connecting();
    } else {
      read_socket();
    }
  }
  return true;
}

void FrameClient::start_connecting() {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(config_.host.c_str(), std::to_string(config_.port).c_str(), &hints, &found);
  if (error != 0)
    return retry_later("cannot find the camera's host " + config_.host + ": " + ::gai_strerror(error));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> addresses(found, &::freeaddrinfo);
  socket_.reset(::socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!socket_.valid()) return retry_later("cannot open a socket for the camera: " + system_text(errno));
  watch_connection(socket_.get());
  if (::connect(socket_.get(), found->ai_addr, found->ai_addrlen) != 0 && errno != EINPROGRESS)
    return retry_later("cannot connect to the camera at " + peer() + ": " + system_text(errno));
  state_ = State::kConnecting;
}

void FrameClient::finish_connecting() {
  int error = 0;
  socklen_t length = sizeof(error);
  if (::getsockopt(socket_.get(), SOL_SOCKET, SO_ERROR, &error, &length) != 0) error = errno;
  if (error != 0) return retry_later("cannot connect to the camera at " + peer() + ": " + system_text(error));
  state_ = State::kConnected;
  retry_s_ = config_.first_retry_s;
  why_.clear();
  assembler_.restart();
  ++counters_.connects;
}

void FrameClient::read_socket() {
  const ssize_t bytes = ::recv(socket_.get(), chunk_.data(), chunk_.size(), 0);
  if (bytes > 0) {
    last_read_ = clock_->now();
    assembler_.append(std::span(chunk_).first(static_cast<std::size_t>(bytes)));
    return;
  }
  if (bytes == 0) return disconnect("the camera at " + peer() + " closed the connection");
  if (errno == EAGAIN || errno == EINTR) return;
  disconnect("lost the camera at " + peer() + ": " + system_text(errno));
}

void FrameClient::disconnect(const std::string& why) {
  ++counters_.disconnects;
  state_ = State::kWaiting;
  socket_.reset();
  why_ = why;
  retry_at_ns_ = steady_ns() + from_seconds(retry_s_).count();
}

void FrameClient::retry_later(const std::string& why) {
  ++counters_.failed_attempts;
  state_ = State::kWaiting;
  socket_.reset();
  why_ = why;
  retry_at_ns_ = steady_ns() + from_seconds(retry_s_).count();
  retry_s_ = std::min(retry_s_ * 2, config_.longest_retry_s);
}

}  // namespace edgesplat::frame_socket
