// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/unique_fd.hpp"

#include <sys/eventfd.h>

#include <unistd.h>
#include <cstdint>
#include <stop_token>

namespace edgesplat::thread {

/// A file descriptor that becomes readable when a stop is requested, so that poll() on a socket ends without
/// waking up now and then. Make it once and keep it: it costs a descriptor. Single-owner; the stop may come
/// from any thread.
class StopFd {
 public:
  explicit StopFd(const std::stop_token& token)
      : token_(token), fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)), on_stop_(token, Signal{fd_.get()}) {}
  StopFd(const StopFd&) = delete;
  StopFd& operator=(const StopFd&) = delete;

  /// For poll(); -1 (which poll() ignores) where the system has no descriptor left.
  [[nodiscard]] int get() const { return fd_.get(); }
  [[nodiscard]] bool listens_to(const std::stop_token& token) const { return token_ == token; }

 private:
  struct Signal {
    int fd;
    void operator()() const {
      const std::uint64_t one = 1;
      (void)!::write(fd, &one, sizeof(one));
    }
  };
  std::stop_token token_;
  UniqueFd fd_;
  std::stop_callback<Signal> on_stop_;
};

}  // namespace edgesplat::thread
