// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/pose_log.hpp"

#include <cinttypes>
#include <cstdio>

namespace edgesplat::app {

PoseLog::PoseLog(const std::filesystem::path& path) {
  if (!path.empty()) file_.open(path, std::ios::trunc);
}

void PoseLog::add(const tracking::StreamedPose& pose) {
  if (!file_) return;
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t stamp_ns = to_ns(pose.stamp);
  const Eigen::Vector3d& p = pose.odom_from_body.translation_m;
  const Eigen::Quaterniond& q = pose.odom_from_body.rotation;
  char line[192];
  std::snprintf(line, sizeof line, "%" PRId64 ".%09" PRId64 " %.6f %.6f %.6f %.8f %.8f %.8f %.8f\n",
                stamp_ns / kSecond_ns, stamp_ns % kSecond_ns, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(),
                q.w());
  file_ << line;
}

}  // namespace edgesplat::app
