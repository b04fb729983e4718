// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/thread/bounded_queue.hpp"

#include <functional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

namespace edgesplat::thread {

/// A named thread that repeats one step until the step says stop, or somebody else does. Joined on
/// destruction. An exception that leaves the step ends the program, as a failed check does: nothing is
/// swallowed. Owned by one thread.
class Worker {
 public:
  /// Returns false to end the thread. Waits inside must end when the token is stopped.
  using Step = std::function<bool(const std::stop_token&)>;

  /// `name` shows up in ps, top and gdb; the kernel keeps its first 15 characters.
  Worker(std::string name, Step step);
  Worker(Worker&&) noexcept = default;
  Worker& operator=(Worker&&) = delete;
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker() = default;  // std::jthread: asks to stop, then joins

  /// Handles every item of `queue` until it is closed and drained, or the worker is stopped.
  template <typename T>
  [[nodiscard]] static Worker consume(std::string name, BoundedQueue<T>& queue,
                                      std::function<void(T)> handle) {
    return Worker(std::move(name), [&queue, handle = std::move(handle)](const std::stop_token& stop) {
      std::optional<T> item = queue.pop(stop);
      if (!item) return false;
      handle(std::move(*item));
      return true;
    });
  }

  void request_stop() { thread_.request_stop(); }
  /// Waits for the thread to end by itself; a second call returns at once.
  void join() {
    if (thread_.joinable()) thread_.join();
  }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::string name_;
  std::jthread thread_;
};

}  // namespace edgesplat::thread
