// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "robot/tracking/tracked_group.hpp"

#include <filesystem>
#include <vector>

namespace edgesplat::app {

/// What a group cost, stage by stage.
struct StageTimes {
  double track_ms = 0.0;
  double keyframe_ms = 0.0;  ///< colouring and keyframe building
  double latency_ms =
      0.0;  ///< newest measurement of the group arrived -> pose known; live and paced runs only
};

/// The run's trajectory and one line a group. Single-owner: filled by one stage, written when the run is
/// over.
class RunLog {
 public:
  void add(const tracking::TrackedGroup& group, int points_in_group, const StageTimes& times);

  /// Writes trajectory.tum (valid poses only) and groups.csv into `folder`. Errors: kIo.
  [[nodiscard]] Status write(const std::filesystem::path& folder) const;

  [[nodiscard]] std::size_t poses() const;
  /// Time from the first group to the last.
  [[nodiscard]] double span_s() const;
  [[nodiscard]] double track_sum_ms() const;

 private:
  struct Row {
    HostTime stamp{};
    geometry::RigidTransform odom_from_body;
    tracking::TrackingHealth health;
    int points_in_group = 0;
    StageTimes times;
  };
  std::vector<Row> rows_;
};

}  // namespace edgesplat::app
