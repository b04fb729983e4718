// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "robot/sync/measure_group.hpp"

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

namespace edgesplat::sync {

/// Whole scans waiting for their image and IMU samples, in time order. Single-owner.
class ScanQueue {
 public:
  explicit ScanQueue(std::size_t max_scans) : max_scans_(max_scans) {}

  /// `start`: the scan's stamp in host time. False (and not kept) where it ends at or before `settled` or
  /// before a scan that waits.
  bool push(HostTime start, const sensor::LidarScan& scan, HostTime settled);
  /// When the oldest scan was complete.
  [[nodiscard]] std::optional<HostTime> earliest_end() const;
  /// More scans wait than may: the oldest has to go now.
  [[nodiscard]] bool crowded() const { return scans_.size() > max_scans_; }
  /// Moves points and end of the oldest scan into `group`.
  void take_earliest(MeasureGroup& group);

 private:
  struct Scan {
    HostTime end;
    bool has_point_times;
    std::vector<GroupPoint> points;
  };
  std::size_t max_scans_;
  std::deque<Scan> scans_;
};

}  // namespace edgesplat::sync
