// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/base/unique_fd.hpp"
#include "common/thread/bounded_queue.hpp"
#include "common/thread/worker.hpp"
#include "tools/virtual_device/frame_message.hpp"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

namespace edgesplat::virtual_device {

/// The camera's end of the frame socket: listens, serves one robot at a time and takes the next one when it
/// goes. Frames go out on a thread of their own, so that a slow robot never delays the LiDAR; it loses the
/// oldest waiting frames instead (counted). Single-owner.
class FrameServer {
 public:
  /// On all interfaces; port 0 = any free one. kIo with the system's reason (port in use).
  static Result<std::unique_ptr<FrameServer>> listen(std::uint16_t port);
  FrameServer(const FrameServer&) = delete;
  FrameServer& operator=(const FrameServer&) = delete;
  ~FrameServer();

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Call before the first push(). False when nobody came in time, or a stop was requested.
  bool wait_for_robot(std::chrono::milliseconds timeout, const std::stop_token& stop);
  void push(const FrameMessage& message, std::vector<std::byte> payload);
  /// Sends what is waiting and ends the connection.
  void finish();

  [[nodiscard]] std::uint64_t sent() const { return sent_; }
  /// Frames that no robot got: none connected, connection broken, or too slow.
  [[nodiscard]] std::uint64_t lost() const { return lost_ + queue_.stats().dropped; }

 private:
  struct Frame {
    FrameMessage message;
    std::vector<std::byte> payload;
  };
  FrameServer(UniqueFd listener, std::uint16_t port);
  bool accept_robot(int timeout_ms);
  void serve(const Frame& frame);

  UniqueFd listener_;
  std::uint16_t port_;
  UniqueFd robot_;
  std::atomic<std::uint64_t> sent_ = 0;
  std::atomic<std::uint64_t> lost_ = 0;
  thread::BoundedQueue<Frame> queue_;
  std::optional<thread::Worker> worker_;
};

}  // namespace edgesplat::virtual_device
