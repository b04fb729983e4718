// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/ingest/ingest.hpp"
#include "server/store/map_file.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

namespace edgesplat::app {

/// Saved maps, and keyframes that came after they were saved, that wait for their robots. They fit only the
/// session of the robot's program that they were made for: its odometry frame began with the program. Until
/// that session is heard, nothing of them is sent. Thread-safe.
class RestoredMaps {
 public:
  RestoredMaps(std::vector<store::StoredMap> maps, std::vector<ingest::IngestedKeyframe> unsaved);

  /// A message of this session came: what is its is to be taken, what is of another session is given up.
  void heard(map::RobotId robot, std::uint64_t session);
  /// A map whose robot was heard.
  [[nodiscard]] std::optional<store::StoredMap> take();
  /// A keyframe whose robot was heard, in their order; to be mapped once there is no map to take.
  [[nodiscard]] std::optional<ingest::IngestedKeyframe> take_keyframe();
  [[nodiscard]] bool has_keyframe() const;

 private:
  void hear_keyframes(map::RobotId robot, std::uint64_t session);

  mutable std::mutex mutex_;
  std::map<map::RobotId, store::StoredMap> waiting_;
  std::vector<store::StoredMap> heard_;
  std::vector<ingest::IngestedKeyframe> unsaved_;
  std::deque<ingest::IngestedKeyframe> heard_keyframes_;
};

}  // namespace edgesplat::app
