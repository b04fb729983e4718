// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <algorithm>
#include <cstdint>

namespace edgesplat::desk {

/// Rate and largest gap of a series of stamps, fed in time order. Single-owner.
class GapStatistics {
 public:
  void add(HostTime stamp) {
    if (count_ == 0) first_ = stamp;
    if (count_ > 0 && stamp - last_ > largest_gap_) {
      largest_gap_ = stamp - last_;
      gap_start_ = last_;
    }
    last_ = stamp;
    ++count_;
  }
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] HostTime first() const { return first_; }
  [[nodiscard]] HostTime gap_start() const { return gap_start_; }
  [[nodiscard]] double largest_gap_s() const { return to_seconds(largest_gap_); }
  [[nodiscard]] double duration_s() const { return count_ == 0 ? 0.0 : to_seconds(last_ - first_); }
  /// 0 where fewer than two stamps or no time passed.
  [[nodiscard]] double rate_hz() const {
    return duration_s() > 0.0 ? static_cast<double>(count_ - 1) / duration_s() : 0.0;
  }

 private:
  std::uint64_t count_ = 0;
  HostTime first_{};
  HostTime last_{};
  HostTime gap_start_{};
  nanoseconds largest_gap_{};
};

}  // namespace edgesplat::desk
