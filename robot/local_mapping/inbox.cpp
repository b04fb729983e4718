// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/local_mapping/inbox.hpp"

#include <utility>

namespace edgesplat::local_mapping {

void Inbox::set_work(bool map_here, bool prune) {
  {
    const std::lock_guard lock(mutex_);
    if (map_here == map_here_ && !prune) return;
    orders_.map_here = map_here_ = map_here;
    orders_.prune = orders_.prune || prune;
    if (!map_here) keyframes_.clear();
  }
  filled_.notify_all();
}

void Inbox::set_resident(std::shared_ptr<const gaussian::GaussianCloud> in_odom) {
  {
    const std::lock_guard lock(mutex_);
    orders_.resident_in_odom = std::move(in_odom);
  }
  filled_.notify_all();
}

void Inbox::retire(std::vector<std::uint32_t> mapped) {
  if (mapped.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    orders_.mapped.insert(orders_.mapped.end(), mapped.begin(), mapped.end());
  }
  filled_.notify_all();
}

void Inbox::submit(std::shared_ptr<const map::Keyframe> keyframe) {
  {
    const std::lock_guard lock(mutex_);
    if (!map_here_) return;
    if (keyframes_.size() == max_keyframes_) {
      keyframes_.pop_front();
      ++dropped_;
    }
    keyframes_.push_back(std::move(keyframe));
  }
  filled_.notify_all();
}

bool Inbox::ordered() const {
  return orders_.map_here || orders_.prune || orders_.resident_in_odom || !orders_.mapped.empty();
}

Inbox::Round Inbox::take(const std::stop_token& stop, std::optional<nanoseconds> patience,
                         bool with_keyframe) {
  std::unique_lock lock(mutex_);
  const auto filled = [&] { return ordered() || settling_ || (with_keyframe && !keyframes_.empty()); };
  if (patience) {
    (void)filled_.wait_for(lock, stop, *patience, filled);
  } else {
    (void)filled_.wait(lock, stop, filled);
  }
  Round round = std::exchange(orders_, {});
  if ((with_keyframe || settling_) && !keyframes_.empty()) {
    round.keyframe = std::move(keyframes_.front());
    keyframes_.pop_front();
  }
  return round;
}

bool Inbox::settle(nanoseconds timeout) {
  std::unique_lock lock(mutex_);
  settling_ = true;
  filled_.notify_all();
  return settled_.wait_for(lock, timeout, [this] { return !settling_; });
}

bool Inbox::settling() const {
  const std::lock_guard lock(mutex_);
  return settling_;
}

void Inbox::done() {
  const std::lock_guard lock(mutex_);
  if (!settling_ || ordered() || !keyframes_.empty()) return;
  settling_ = false;
  settled_.notify_all();
}

std::uint64_t Inbox::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace edgesplat::local_mapping
