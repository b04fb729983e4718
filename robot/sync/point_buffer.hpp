// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "robot/sync/measure_group.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace edgesplat::sync {

/// The part of time that one group covers: (begin, end].
struct Cut {
  HostTime begin{};
  HostTime end{};
};

/// Packets of one LiDAR waiting for their group, by time of their first ray. Single-owner.
class PointBuffer {
 public:
  explicit PointBuffer(std::size_t max_points, std::uint8_t unit = 0)
      : max_points_(max_points), unit_(unit) {}

  /// Keeps the packet; the oldest packets go where the buffer is full.
  void push(HostTime first_ray, std::vector<sensor::LidarPoint> points);
  /// Removes the points up to cut.end, oldest first. A point before cut.begin counts as clamped where it is
  /// at most `clamp` older (its clock relation was refined), else as late.
  [[nodiscard]] std::vector<GroupPoint> take(const Cut& cut, nanoseconds clamp);

  [[nodiscard]] std::optional<HostTime> earliest() const;
  [[nodiscard]] std::uint64_t late() const { return late_; }
  [[nodiscard]] std::uint64_t clamped() const { return clamped_; }
  [[nodiscard]] std::uint64_t overflow() const { return overflow_; }

 private:
  struct Packet {
    HostTime first_ray;
    std::vector<sensor::LidarPoint> points;
    std::size_t taken = 0;  ///< points that already went into a group
  };
  void take_from(Packet& packet, const Cut& cut, nanoseconds clamp, std::vector<GroupPoint>& out);

  std::size_t max_points_;
  std::uint8_t unit_;
  std::size_t size_ = 0;  ///< points not yet taken
  std::deque<Packet> packets_;
  std::uint64_t late_ = 0;
  std::uint64_t clamped_ = 0;
  std::uint64_t overflow_ = 0;
};

}  // namespace edgesplat::sync
