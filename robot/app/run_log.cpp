// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/run_log.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/trajectory_file.hpp"
#include "robot/tracking/health_csv.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace edgesplat::app {

void RunLog::add(const tracking::TrackedGroup& group, int points_in_group, const StageTimes& times) {
  rows_.push_back({group.stamp, group.odom_from_body, group.health, points_in_group, times});
}

std::size_t RunLog::poses() const {
  std::size_t count = 0;
  for (const Row& row : rows_) count += row.health.state != tracking::TrackingState::kInitialising ? 1 : 0;
  return count;
}

double RunLog::span_s() const {
  return rows_.size() < 2 ? 0.0 : to_seconds(rows_.back().stamp - rows_.front().stamp);
}

double RunLog::track_sum_ms() const {
  double sum_ms = 0.0;
  for (const Row& row : rows_) sum_ms += row.times.track_ms;
  return sum_ms;
}

Status RunLog::write(const std::filesystem::path& folder) const {
  std::vector<io::StampedPose> poses;
  std::string csv = fmt::format("stamp_s,points_in_group,{},track_ms,keyframe_ms,latency_ms\n",
                                tracking::health_csv_header());
  for (const Row& row : rows_) {
    if (row.health.state != tracking::TrackingState::kInitialising)
      poses.push_back({row.stamp, row.odom_from_body});
    const std::int64_t ns = to_ns(row.stamp);
    csv += fmt::format("{}.{:09},{},{},{:.3f},{:.3f},{:.3f}\n", ns / 1'000'000'000, ns % 1'000'000'000,
                       row.points_in_group, tracking::health_csv(row.health), row.times.track_ms,
                       row.times.keyframe_ms, row.times.latency_ms);
  }
  EDGESPLAT_TRY_STATUS(io::write_tum(folder / "trajectory.tum", poses));
  return io::write_file_atomically(folder / "groups.csv", std::as_bytes(std::span(csv.data(), csv.size())));
}

}  // namespace edgesplat::app
