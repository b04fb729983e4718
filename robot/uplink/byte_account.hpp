// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <algorithm>
#include <cstddef>

namespace edgesplat::uplink {

/// A budget of bytes a second that can be saved up for a second. Whoever wants to spend asks first and
/// does without where there is not enough; nobody waits. Pure; single-owner.
class ByteAccount {
 public:
  /// `bytes_per_s` 0: no limit.
  ByteAccount(double bytes_per_s, HostTime now) : bytes_per_s_(bytes_per_s), at_(now) {}

  /// Another budget from now on; nothing saved is taken over, so that the mean holds from the start.
  void set_rate(double bytes_per_s, HostTime now) {
    bytes_per_s_ = bytes_per_s;
    balance_ = 0.0;
    at_ = now;
  }
  /// Takes `bytes` where the balance covers them. One larger than all that can be saved takes everything, and
  /// the debt is paid off first.
  bool spend(std::size_t bytes, HostTime now) {
    save(now);
    const auto amount = static_cast<double>(bytes);
    if (bytes_per_s_ > 0 && balance_ < std::min(amount, saved_at_most())) return false;
    if (bytes_per_s_ > 0) balance_ -= amount;
    return true;
  }

 private:
  static constexpr double kSaved_s = 1.0;
  [[nodiscard]] double saved_at_most() const { return bytes_per_s_ * kSaved_s; }
  void save(HostTime now) {
    balance_ = std::min(saved_at_most(), balance_ + bytes_per_s_ * to_seconds(now - at_));
    at_ = now;
  }

  double bytes_per_s_;
  double balance_ = 0.0;
  HostTime at_;
};

}  // namespace edgesplat::uplink
