// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/sync/measure_group.hpp"
#include "robot/sync/point_buffer.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace edgesplat::sync {

/// IMU samples waiting for their group, in strictly rising time. Single-owner.
class ImuBuffer {
 public:
  explicit ImuBuffer(std::size_t max_samples) : max_samples_(max_samples) {}

  /// A sample at or before `settled` (the last group's end) by `clamp` or more is late and dropped; a little
  /// before it, it is moved just behind the newest sample.
  void push(GroupImu sample, HostTime settled, nanoseconds clamp);
  /// The samples of (begin, end] with one on either side (see MeasureGroup::imu). The last one at or before
  /// `end` stays for the next group.
  [[nodiscard]] std::vector<GroupImu> take(const Cut& cut);

  /// The first sample after `t`.
  [[nodiscard]] std::optional<HostTime> first_after(HostTime t) const;
  [[nodiscard]] std::uint64_t late() const { return late_; }
  [[nodiscard]] std::uint64_t overflow() const { return overflow_; }

 private:
  std::size_t max_samples_;
  std::deque<GroupImu> samples_;
  std::uint64_t late_ = 0;
  std::uint64_t overflow_ = 0;
};

}  // namespace edgesplat::sync
