// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/base/unique_fd.hpp"
#include "common/thread/stop_fd.hpp"
#include "common/time/clock.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <string>

namespace edgesplat::serial_imu {

struct SerialPortConfig {
  std::string path = "/dev/ttyUSB0";
  int baud = 921600;       ///< 9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600 or 1000000
  double silence_s = 0.5;  ///< no byte this long: opened anew, [0.05, 60]
  double retry_s = 0.3;    ///< between two attempts to open, [0.01, 60]
};

struct PortCounters {
  std::uint64_t opens = 0;
  std::uint64_t failed_opens = 0;
  std::uint64_t losses = 0;  ///< unplugged, or silent
};

/// A serial line, raw, 8N1, that comes back by itself: a device that is not there is no error but a state.
/// Each loss and each return is one line in the log. Thread-bound.
class SerialPort {
 public:
  /// kInvalidConfig for a rate that no serial line has, or an empty path.
  static Result<SerialPort> create(const SerialPortConfig& config, const Clock& clock);

  /// What came, borrowed until the next call; empty when `stop` is requested or `timeout` has passed.
  struct Bytes {
    std::span<const std::byte> bytes;
    HostTime arrival{};
    bool first = false;  ///< since the line was opened: what waited before belongs to another frame
  };
  [[nodiscard]] Bytes receive(const std::stop_token& stop, nanoseconds timeout);
  [[nodiscard]] bool connected() const { return fd_.valid(); }
  [[nodiscard]] const PortCounters& counters() const { return counters_; }

 private:
  SerialPort(SerialPortConfig config, const Clock& clock) : config_(std::move(config)), clock_(&clock) {}
  void try_open();
  void lose(const std::string& why);

  SerialPortConfig config_;
  const Clock* clock_;
  UniqueFd fd_;
  std::unique_ptr<thread::StopFd> stop_fd_;
  HostTime retry_at_{};
  HostTime last_byte_{};
  bool fresh_ = false;
  bool said_ = false;  ///< that it is not there
  PortCounters counters_;
  std::array<std::byte, 4096> chunk_{};
};

}  // namespace edgesplat::serial_imu
