// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/map/keyframe.hpp"
#include "common/time/time.hpp"

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <vector>

namespace edgesplat::local_mapping {

/// What is wanted of the robot's mapping, from whichever thread, until its own thread comes round. Orders are
/// kept to their newest value, keyframes in a bounded queue whose oldest are dropped and counted; the list of
/// mapped keyframes is 4 bytes for each. Nobody who puts something in waits. Thread-safe.
class Inbox {
 public:
  /// Everything that was ordered, and the oldest keyframe where one was wanted.
  struct Round {
    std::optional<bool> map_here;
    bool prune = false;
    std::optional<std::shared_ptr<const gaussian::GaussianCloud>> resident_in_odom;
    std::vector<std::uint32_t> mapped;
    std::shared_ptr<const map::Keyframe> keyframe;
  };

  explicit Inbox(std::size_t max_keyframes) : max_keyframes_(max_keyframes) {}

  /// Keyframes are taken in LOCAL alone; those that wait when it ends are the server's.
  void set_work(bool map_here, bool prune);
  void set_resident(std::shared_ptr<const gaussian::GaussianCloud> in_odom);
  void retire(std::vector<std::uint32_t> mapped);
  void submit(std::shared_ptr<const map::Keyframe> keyframe);

  /// Waits for an order, or a keyframe where `with_keyframe`; up to `patience`, for ever without.
  [[nodiscard]] Round take(const std::stop_token& stop, std::optional<nanoseconds> patience,
                           bool with_keyframe);
  /// Asks the taker to get through everything and say so; waits for it up to `timeout`.
  bool settle(nanoseconds timeout);
  [[nodiscard]] bool settling() const;
  /// The taker has done all it took: true, and settle() ends, where nothing came meanwhile.
  void done();
  [[nodiscard]] std::uint64_t dropped() const;

 private:
  [[nodiscard]] bool ordered() const;

  const std::size_t max_keyframes_;
  mutable std::mutex mutex_;
  std::condition_variable_any filled_;
  std::condition_variable settled_;
  Round orders_;
  bool map_here_ = false;
  std::deque<std::shared_ptr<const map::Keyframe>> keyframes_;
  std::uint64_t dropped_ = 0;
  bool settling_ = false;
};

}  // namespace edgesplat::local_mapping
