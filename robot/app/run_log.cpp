// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/run_log.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/trajectory_file.hpp"

#include <cinttypes>
#include <cstdio>
#include <string>

namespace edgesplat::app {
namespace {

const char* name_of(tracking::TrackingState state) {
  switch (state) {
    case tracking::TrackingState::kInitialising:
      return "initialising";
    case tracking::TrackingState::kTracking:
      return "tracking";
    case tracking::TrackingState::kCoasting:
      return "coasting";
  }
  return "unknown";
}

}  // namespace

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
  std::string csv =
      "stamp_s,state,points_in_group,points_used,iterations,residual_rms_m,translation_conditioning,track_ms,"
      "keyframe_ms,latency_ms\n";
  for (const Row& row : rows_) {
    if (row.health.state != tracking::TrackingState::kInitialising)
      poses.push_back({row.stamp, row.odom_from_body});
    char line[256];
    std::snprintf(line, sizeof line, "%" PRId64 ".%09" PRId64 ",%s,%d,%d,%d,%.5f,%.2e,%.3f,%.3f,%.3f\n",
                  to_ns(row.stamp) / 1'000'000'000, to_ns(row.stamp) % 1'000'000'000,
                  name_of(row.health.state), row.points_in_group, row.health.points_used,
                  row.health.iterations, row.health.residual_rms_m, row.health.translation_conditioning,
                  row.times.track_ms, row.times.keyframe_ms, row.times.latency_ms);
    csv += line;
  }
  EDGESPLAT_TRY_STATUS(io::write_tum(folder / "trajectory.tum", poses));
  return io::write_file_atomically(folder / "groups.csv", std::as_bytes(std::span(csv.data(), csv.size())));
}

}  // namespace edgesplat::app
