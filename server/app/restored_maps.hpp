// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/store/map_file.hpp"

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

namespace edgesplat::app {

/// Saved maps that wait for their robots. A map fits only the session of the robot's program that it was made
/// for: its odometry frame began with the program. Until that session is heard, nothing of it is sent.
/// Thread-safe.
class RestoredMaps {
 public:
  explicit RestoredMaps(std::vector<store::StoredMap> maps);

  /// A message of this session came: its map is to be taken, one of another session is given up.
  void heard(map::RobotId robot, std::uint64_t session);
  /// A map whose robot was heard.
  [[nodiscard]] std::optional<store::StoredMap> take();

 private:
  std::mutex mutex_;
  std::map<map::RobotId, store::StoredMap> waiting_;
  std::vector<store::StoredMap> heard_;
};

}  // namespace edgesplat::app
