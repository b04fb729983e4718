// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/base/unique_fd.hpp"
#include "common/thread/stop_fd.hpp"
#include "common/time/clock.hpp"
#include "robot/drivers/frame_socket/frame_assembler.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace edgesplat::frame_socket {

struct FrameClientConfig {
  std::string host = "127.0.0.1";  ///< address of the camera; a name is looked up at each attempt
  std::uint16_t port = 56600;
  double first_retry_s = 0.1;    ///< pause after the first failed attempt, doubled each time, [0.001, 60]
  double longest_retry_s = 5.0;  ///< [first_retry_s, 600]
};

struct ClientCounters {
  std::uint64_t connects = 0;
  std::uint64_t disconnects = 0;
  std::uint64_t failed_attempts = 0;
};

struct ReceivedFrame {
  EncodedFrame frame;
  HostTime arrival{};  ///< of its last byte
};

/// TCP connection to the camera that comes back by itself: a camera that is not there is no error but a
/// state. Non-blocking socket and poll; thread-bound (one thread calls receive()).
class FrameClient {
 public:
  /// kInvalidConfig for an empty host or port 0. `clock` must outlive the client.
  static Result<FrameClient> create(FrameClientConfig config, const Clock& clock);

  /// Waits for the next frame, connecting again where needed. Nothing when `stop` is requested or `timeout`
  /// has passed.
  [[nodiscard]] std::optional<ReceivedFrame> receive(const std::stop_token& stop, nanoseconds timeout);

  [[nodiscard]] bool connected() const { return state_ == State::kConnected; }
  [[nodiscard]] const ClientCounters& counters() const { return counters_; }
  [[nodiscard]] const AssemblerCounters& assembler_counters() const { return assembler_.counters(); }
  /// Why there is no connection ("connection refused by 127.0.0.1:56600"); empty while connected.
  [[nodiscard]] const std::string& why_not_connected() const { return why_; }

 private:
  enum class State : std::uint8_t { kWaiting, kConnecting, kConnected };

  FrameClient(FrameClientConfig config, const Clock& clock);
  void start_connecting();
  void finish_connecting();
  void read_socket();
  void disconnect(const std::string& why);
  void retry_later(const std::string& why);
  [[nodiscard]] std::string peer() const;
  [[nodiscard]] static std::int64_t steady_ns();
  /// One wait; false when stopped.
  bool wait(std::int64_t until_ns);

  FrameClientConfig config_;
  const Clock* clock_;
  State state_ = State::kWaiting;
  std::unique_ptr<thread::StopFd> stop_fd_;
  UniqueFd socket_;
  FrameAssembler assembler_;
  std::vector<std::byte> chunk_;
  std::int64_t retry_at_ns_ = 0;  ///< on the steady clock: waiting is real time even where measuring is not
  double retry_s_;
  HostTime last_read_{};
  ClientCounters counters_;
  std::string why_ = "not tried yet";
};

}  // namespace edgesplat::frame_socket
