// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

namespace edgesplat::log {

/// Lets one line through each interval and counts the rest:
///   if (gaps_.allow()) EDGESPLAT_LOG_WARN("livox", "packet gap", "lost", n, "suppressed",
///   gaps_.take_suppressed());
/// Thread-safe and wait-free.
class RateLimiter {
 public:
  using Clock = std::chrono::steady_clock;  // for the reader's eyes only: never enters a computation
  explicit RateLimiter(std::chrono::nanoseconds interval) : interval_(interval) {}

  [[nodiscard]] bool allow() { return allow(Clock::now()); }
  [[nodiscard]] bool allow(Clock::time_point now) {
    const std::int64_t now_ns = now.time_since_epoch().count();
    std::int64_t next_ns = next_ns_.load(std::memory_order_relaxed);
    if (now_ns >= next_ns && next_ns_.compare_exchange_strong(next_ns, now_ns + interval_.count()))
      return true;
    suppressed_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  /// How many lines were held back since the last call.
  [[nodiscard]] std::uint64_t take_suppressed() { return suppressed_.exchange(0); }

 private:
  std::chrono::nanoseconds interval_;
  std::atomic<std::int64_t> next_ns_{INT64_MIN};
  std::atomic<std::uint64_t> suppressed_{0};
};

}  // namespace edgesplat::log
