// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/scan_queue.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::sync {

bool ScanQueue::push(HostTime start, const sensor::LidarScan& scan, HostTime settled) {
  std::int32_t last_ns = 0;
  if (scan.has_point_times)
    for (const sensor::LidarPoint& point : scan.points) last_ns = std::max(last_ns, point.offset_ns);
  const HostTime end = start + nanoseconds(last_ns);
  if (end <= settled || (!scans_.empty() && end <= scans_.back().end)) return false;
  Scan waiting{end, scan.has_point_times, {}};
  waiting.points.reserve(scan.points.size());
  for (const sensor::LidarPoint& point : scan.points) {
    const std::int32_t before_end_ns = scan.has_point_times ? last_ns - std::max(0, point.offset_ns) : 0;
    waiting.points.push_back({point.p_in_lidar_m, point.reflectivity, before_end_ns, point.noise_class});
  }
  std::stable_sort(
      waiting.points.begin(), waiting.points.end(),
      [](const GroupPoint& a, const GroupPoint& b) { return a.before_end_ns > b.before_end_ns; });
  scans_.push_back(std::move(waiting));
  return true;
}

std::optional<HostTime> ScanQueue::earliest_end() const {
  if (scans_.empty()) return std::nullopt;
  return scans_.front().end;
}

void ScanQueue::take_earliest(MeasureGroup& group) {
  group.end = scans_.front().end;
  group.has_point_times = scans_.front().has_point_times;
  group.points = std::move(scans_.front().points);
  scans_.pop_front();
}

}  // namespace edgesplat::sync
