// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/serial_imu/serial_port.hpp"

#include "common/log/log.hpp"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>

namespace edgesplat::serial_imu {
namespace {

std::string system_text(int error) {
  return std::generic_category().message(error);
}

std::optional<speed_t> speed_of(int baud) {
  constexpr std::array<std::pair<int, speed_t>, 9> kSpeeds{{{9600, B9600},
                                                            {19200, B19200},
                                                            {38400, B38400},
                                                            {57600, B57600},
                                                            {115200, B115200},
                                                            {230400, B230400},
                                                            {460800, B460800},
                                                            {921600, B921600},
                                                            {1000000, B1000000}}};
  for (const auto& [rate, code] : kSpeeds)
    if (rate == baud) return code;
  return std::nullopt;
}

/// Raw bytes, 8N1, no flow control. False where it is no terminal or does not do this rate.
bool make_raw(int fd, speed_t speed) {
  termios settings{};
  if (::tcgetattr(fd, &settings) != 0) return false;
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  return ::cfsetispeed(&settings, speed) == 0 && ::cfsetospeed(&settings, speed) == 0 &&
         ::tcsetattr(fd, TCSANOW, &settings) == 0;
}

}  // namespace

Result<SerialPort> SerialPort::create(const SerialPortConfig& config, const Clock& clock) {
  if (config.path.empty())
    return fail(Errc::kInvalidConfig, "the serial line needs a path, such as /dev/ttyUSB0");
  if (!speed_of(config.baud))
    return fail(Errc::kInvalidConfig,
                std::to_string(config.baud) + " baud is no rate of a serial line; use 921600");
  return SerialPort(config, clock);
}

void SerialPort::try_open() {
  UniqueFd fd(::open(config_.path.c_str(), O_RDONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (fd.valid() && make_raw(fd.get(), *speed_of(config_.baud))) {
    (void)::tcflush(fd.get(), TCIFLUSH);
    fd_ = std::move(fd);
    ++counters_.opens;
    fresh_ = true;
    last_byte_ = clock_->now();
    return;
  }
  ++counters_.failed_opens;
  retry_at_ = clock_->now() + from_seconds(config_.retry_s);
  if (!said_)
    EDGESPLAT_LOG_WARN("serial_imu", "not there yet", "path", config_.path, "why", system_text(errno));
  said_ = true;
}

void SerialPort::lose(const std::string& why) {
  fd_.reset();
  ++counters_.losses;
  retry_at_ = clock_->now();
  if (!said_) EDGESPLAT_LOG_WARN("serial_imu", "lost", "path", config_.path, "why", why);
  said_ = true;
}

SerialPort::Bytes SerialPort::receive(const std::stop_token& stop, nanoseconds timeout) {
  if (!stop_fd_ || !stop_fd_->listens_to(stop)) stop_fd_ = std::make_unique<thread::StopFd>(stop);
  const HostTime until = clock_->now() + timeout;
  while (!stop.stop_requested()) {
    HostTime now = clock_->now();
    if (now >= until) return {};
    if (!connected() && now >= retry_at_) try_open();
    const HostTime silent_at = last_byte_ + from_seconds(config_.silence_s);
    const HostTime wake = std::min(until, connected() ? silent_at : retry_at_);
    const auto wait_ms =
        std::max<std::int64_t>(0, std::chrono::ceil<std::chrono::milliseconds>(wake - now).count());
    std::array<pollfd, 2> fds{pollfd{stop_fd_->get(), POLLIN, 0}, pollfd{fd_.get(), POLLIN, 0}};
    const int ready =
        ::poll(fds.data(), fds.size(), static_cast<int>(std::min<std::int64_t>(wait_ms, 60'000)));
    now = clock_->now();
    if (fds[0].revents != 0) return {};
    if (ready <= 0 || fds[1].revents == 0) {
      if (connected() && now >= silent_at) lose("silent");
      continue;
    }
    const ssize_t bytes = ::read(fd_.get(), chunk_.data(), chunk_.size());
    if (bytes > 0) {
      last_byte_ = now;
      if (std::exchange(said_, false)) EDGESPLAT_LOG_INFO("serial_imu", "here", "path", config_.path);
      return {std::span(chunk_).first(static_cast<std::size_t>(bytes)), now, std::exchange(fresh_, false)};
    }
    if (bytes < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    lose(bytes == 0 ? "unplugged" : system_text(errno));
    retry_at_ = now + from_seconds(config_.retry_s);
  }
  return {};
}

}  // namespace edgesplat::serial_imu
