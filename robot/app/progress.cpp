// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/progress.hpp"

#include <cinttypes>
#include <cstdio>

namespace edgesplat::app {

void Progress::on_pose(const tracking::TrackedGroup& group) {
  if (!enabled_) return;
  const HostTime now = clock_.now();
  ++poses_;
  if (!started_) {
    started_ = true;
    first_stamp_ = group.stamp;
    last_line_ = now;
    return;
  }
  if (now - last_line_ < std::chrono::seconds(1)) return;
  last_line_ = now;
  const Eigen::Vector3d& p = group.odom_from_body.translation_m;
  std::printf("{\"recorded_s\": %.3f, \"poses\": %" PRId64
              ", \"position_m\": [%.3f, %.3f, %.3f], \"points_used\": %d}\n",
              to_seconds(group.stamp - first_stamp_), poses_, p.x(), p.y(), p.z(), group.health.points_used);
  std::fflush(stdout);
}

}  // namespace edgesplat::app
