// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "robot/sync/measure_group.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace edgesplat::sync {

/// Images waiting for their group, in time order; bounded in number and bytes, the oldest go first.
/// Single-owner.
class ImageBuffer {
 public:
  ImageBuffer(std::size_t max_images, std::size_t max_bytes)
      : max_images_(max_images), max_bytes_(max_bytes) {}

  /// False (and not kept) where the image is not newer than all before it.
  bool push(HostTime t, const sensor::CameraFrame& frame);
  [[nodiscard]] std::optional<HostTime> earliest() const;
  /// The newest ever pushed, taken or not.
  [[nodiscard]] std::optional<HostTime> newest_seen() const { return newest_seen_; }
  [[nodiscard]] GroupImage take_earliest();
  /// Drops images at or before `t` and tells how many.
  std::uint64_t drop_until(HostTime t);
  /// Removes and gives the image nearest to `t` within `tolerance`.
  [[nodiscard]] std::optional<GroupImage> take_nearest(HostTime t, nanoseconds tolerance);
  [[nodiscard]] std::uint64_t overflow() const { return overflow_; }

 private:
  struct Waiting {
    HostTime t;
    GroupImage image;
  };
  void forget(const Waiting& waiting);

  std::size_t max_images_;
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::deque<Waiting> images_;
  std::optional<HostTime> newest_seen_;
  std::uint64_t overflow_ = 0;
};

}  // namespace edgesplat::sync
