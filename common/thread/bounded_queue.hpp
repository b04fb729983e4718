// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/check.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>

namespace edgesplat::thread {

/// What a full queue does with one more item.
enum class Overflow : std::uint8_t {
  kBlock,       ///< the producer waits
  kDropOldest,  ///< the oldest items make room (live data: the newest counts)
  kDropNewest,  ///< the new item is refused
};

enum class PushResult : std::uint8_t {
  kAccepted,       ///< nothing was lost
  kDroppedOldest,  ///< accepted; at least one older item was dropped and counted
  kDroppedNewest,  ///< refused and counted: no room, or larger than the whole queue's bytes
  kClosed,         ///< refused: the queue is closed
};

struct QueueLimits {
  std::size_t items = 1;                                        ///< >= 1
  std::size_t bytes = std::numeric_limits<std::size_t>::max();  ///< sum of the sizes given to push()
};

struct QueueStats {
  std::uint64_t accepted = 0;
  std::uint64_t dropped = 0;  ///< items lost to overflow (never to close())
  std::size_t items = 0;
  std::size_t bytes = 0;
  std::size_t most_items = 0;  ///< high-water mark
};

/// A bounded queue between two stages. Any number of producers and consumers; thread-safe. Waiting is on
/// condition variables. After close() producers are refused and consumers get what is left, then nothing.
template <typename T>
class BoundedQueue {
 public:
  explicit BoundedQueue(QueueLimits limits, Overflow overflow) : limits_(limits), overflow_(overflow) {
    EDGESPLAT_CHECK(limits.items > 0, "a queue holds at least one item");
  }
  BoundedQueue(const BoundedQueue&) = delete;
  BoundedQueue& operator=(const BoundedQueue&) = delete;

  /// Hands over an item of `size_bytes` (0 where bytes are not limited).
  PushResult push(T item, std::size_t size_bytes = 0) {
    std::unique_lock lock(mutex_);
    if (closed_) return PushResult::kClosed;
    if (size_bytes > limits_.bytes) return count_refused();
    PushResult result = PushResult::kAccepted;
    if (!has_room(size_bytes)) {
      if (overflow_ == Overflow::kDropNewest) return count_refused();
      if (overflow_ == Overflow::kBlock) {
        room_.wait(lock, [&] { return closed_ || has_room(size_bytes); });
        if (closed_) return PushResult::kClosed;
      }
      while (!has_room(size_bytes)) {
        (void)take_front();
        ++stats_.dropped;
        result = PushResult::kDroppedOldest;
      }
    }
    entries_.push_back({std::move(item), size_bytes});
    stats_.bytes += size_bytes;
    ++stats_.accepted;
    stats_.most_items = std::max(stats_.most_items, entries_.size());
    lock.unlock();
    filled_.notify_one();
    return result;
  }

  /// The oldest item; waits for one. Nothing once the queue is closed and empty.
  [[nodiscard]] std::optional<T> pop() {
    std::unique_lock lock(mutex_);
    filled_.wait(lock, [&] { return closed_ || !entries_.empty(); });
    return take_and_unlock(lock);
  }
  /// The same; nothing also when `stop` is requested while the queue is empty.
  [[nodiscard]] std::optional<T> pop(std::stop_token stop) {
    std::unique_lock lock(mutex_);
    (void)filled_.wait(lock, stop, [&] { return closed_ || !entries_.empty(); });
    return take_and_unlock(lock);
  }
  /// The same; nothing also after `timeout`. Ask finished() to tell an end from a pause.
  [[nodiscard]] std::optional<T> pop_for(std::chrono::nanoseconds timeout) {
    std::unique_lock lock(mutex_);
    (void)filled_.wait_for(lock, timeout, [&] { return closed_ || !entries_.empty(); });
    return take_and_unlock(lock);
  }
  /// The same; nothing also when `stop` is requested while the queue is empty.
  [[nodiscard]] std::optional<T> pop_for(std::chrono::nanoseconds timeout, std::stop_token stop) {
    std::unique_lock lock(mutex_);
    (void)filled_.wait_for(lock, stop, timeout, [&] { return closed_ || !entries_.empty(); });
    return take_and_unlock(lock);
  }
  /// The oldest item if there is one now.
  [[nodiscard]] std::optional<T> try_pop() {
    std::unique_lock lock(mutex_);
    return take_and_unlock(lock);
  }

  /// No more items: wakes everybody who waits. Can be called more than once.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    filled_.notify_all();
    room_.notify_all();
  }
  /// Closed and empty: no pop() will ever return an item again.
  [[nodiscard]] bool finished() const {
    const std::lock_guard lock(mutex_);
    return closed_ && entries_.empty();
  }
  [[nodiscard]] std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return entries_.size();
  }
  [[nodiscard]] QueueStats stats() const {
    const std::lock_guard lock(mutex_);
    QueueStats stats = stats_;
    stats.items = entries_.size();
    return stats;
  }

 private:
  struct Entry {
    T item;
    std::size_t size_bytes;
  };

  [[nodiscard]] bool has_room(std::size_t size_bytes) const {
    return entries_.size() < limits_.items && size_bytes <= limits_.bytes - stats_.bytes;
  }
  PushResult count_refused() {
    ++stats_.dropped;
    return PushResult::kDroppedNewest;
  }
  T take_front() {
    Entry entry = std::move(entries_.front());
    entries_.pop_front();
    stats_.bytes -= entry.size_bytes;
    return std::move(entry.item);
  }
  std::optional<T> take_and_unlock(std::unique_lock<std::mutex>& lock) {
    if (entries_.empty()) return std::nullopt;
    std::optional<T> item = take_front();
    lock.unlock();
    // With a byte limit one item may make room for several producers, or not for the one that is woken.
    room_.notify_all();
    return item;
  }

  const QueueLimits limits_;
  const Overflow overflow_;
  mutable std::mutex mutex_;
  std::condition_variable_any filled_;
  std::condition_variable_any room_;
  std::deque<Entry> entries_;
  QueueStats stats_;
  bool closed_ = false;
};

}  // namespace edgesplat::thread
