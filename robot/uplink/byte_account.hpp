// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace edgesplat::uplink {

/// What the link has done and has yet to do for this robot, over all lanes: acknowledgements, heartbeats and
/// repetitions too.
struct LinkLoad {
  std::uint64_t sent_bytes = 0;    ///< since the link began
  std::uint64_t unsent_bytes = 0;  ///< taken over and not sent yet
};

/// A budget of bytes a second over everything the link sends. What is not used is saved up, to a second's
/// worth or one keyframe. Whoever wants to send asks first and does without where there is not enough; nobody
/// waits. Pure; single-owner.
class ByteAccount {
 public:
  /// `bytes_per_s` 0: no limit. `keyframe_bytes`: can always be saved up for.
  ByteAccount(double bytes_per_s, std::size_t keyframe_bytes, HostTime now)
      : bytes_per_s_(bytes_per_s), keyframe_bytes_(static_cast<double>(keyframe_bytes)), at_(now) {}

  /// Another budget from now on; nothing saved is taken over, so that the mean holds from the start.
  void set_rate(double bytes_per_s, const LinkLoad& load, HostTime now) {
    bytes_per_s_ = bytes_per_s;
    balance_ = 0.0;
    sent_before_ = load.sent_bytes;
    at_ = now;
  }
  /// `bytes` more may be sent beside what is unsent still. More than can be saved needs all that can, and
  /// leaves a debt.
  [[nodiscard]] bool covers(std::size_t bytes, const LinkLoad& load, HostTime now) {
    save(load, now);
    if (bytes_per_s_ <= 0.0) return true;
    const double left = balance_ - static_cast<double>(load.unsent_bytes);
    return left >= std::min(static_cast<double>(bytes), saved_at_most());
  }

 private:
  static constexpr double kSaved_s = 1.0;
  [[nodiscard]] double saved_at_most() const { return std::max(bytes_per_s_ * kSaved_s, keyframe_bytes_); }
  void save(const LinkLoad& load, HostTime now) {
    balance_ -= static_cast<double>(load.sent_bytes - sent_before_);
    balance_ = std::min(saved_at_most(), balance_ + bytes_per_s_ * to_seconds(now - at_));
    sent_before_ = load.sent_bytes;
    at_ = now;
  }

  double bytes_per_s_;
  double keyframe_bytes_;
  double balance_ = 0.0;
  std::uint64_t sent_before_ = 0;
  HostTime at_;
};

}  // namespace edgesplat::uplink
