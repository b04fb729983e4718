// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <algorithm>

namespace edgesplat::aravis {

/// How long a device has been silent while it was listened to. A robot that was itself held up (a busy
/// machine, a debugger) has not heard what still waits for it, and must not blame the device. Single-owner.
class SilenceWatch {
 public:
  /// The device sent something, or began to be listened to.
  void heard(HostTime now) {
    heard_ = listened_until_ = now;
    held_up_ = {};
  }
  /// In vain, from `begin` to `end`; `asked` is for how long the wait should have been.
  void listened(HostTime begin, HostTime end, nanoseconds asked) {
    add(begin - listened_until_);
    add(end - begin - asked);
    listened_until_ = std::max(begin, end);
  }
  [[nodiscard]] nanoseconds silence(HostTime now) const { return now - heard_ - held_up_; }
  [[nodiscard]] HostTime last_heard() const { return heard_; }

 private:
  static constexpr nanoseconds kSlack{100'000'000};  ///< work between waits, and a late wake-up
  void add(nanoseconds delay) {
    if (delay > kSlack) held_up_ += delay;
  }

  HostTime heard_{};
  HostTime listened_until_{};
  nanoseconds held_up_{};
};

}  // namespace edgesplat::aravis
