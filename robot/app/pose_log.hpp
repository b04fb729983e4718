// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/pose_stream.hpp"

#include <filesystem>
#include <fstream>

namespace edgesplat::app {

/// The poses at the IMU's rate as they come, one line each in TUM's format (s, m, quaternion xyzw; odom from
/// body). A disk that takes nothing costs the file only. Single-owner.
class PoseLog {
 public:
  /// Empty: nothing is written.
  explicit PoseLog(const std::filesystem::path& path);
  void add(const tracking::StreamedPose& pose);

 private:
  std::ofstream file_;
};

}  // namespace edgesplat::app
