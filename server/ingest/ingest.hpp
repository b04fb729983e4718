// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/transport.hpp"
#include "common/map/keyframe.hpp"
#include "common/metrics/registry.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>

namespace edgesplat::ingest {

/// A keyframe that passed every check, with where and when it came from.
struct IngestedKeyframe {
  map::RobotId robot;
  std::uint64_t session = 0;  ///< of the robot's program: another one means a new `odom`, hence a new map
  HostTime received{};        ///< by this server's clock
  map::Keyframe keyframe;
};

/// Turns messages into keyframes: decodes, refuses what is corrupt, drops what came before. Pure;
/// single-owner. Counts ingest.keyframes, .bytes, .corrupt, .duplicates and .stale (of a program that a newer
/// one replaced).
class Ingest {
 public:
  /// `registry` must outlive this. At most `max_robots` robots are served; others are counted as .refused.
  Ingest(metrics::Registry& registry, std::size_t max_robots);

  /// The keyframe in a message of the keyframe lane, or nothing where it was refused and counted.
  std::optional<IngestedKeyframe> take(const link::Message& message, HostTime received);

 private:
  struct Robot {
    std::uint64_t session = 0;
    std::deque<std::uint64_t> former_sessions;  ///< the last few
    std::set<std::uint32_t> recent;             ///< keyframe ids above floor
    std::uint32_t floor = 0;                    ///< all ids below are settled
  };
  Robot* admit(map::RobotId robot, std::uint64_t session);
  static bool remember(Robot& robot, std::uint32_t id);

  std::size_t max_robots_;
  std::map<map::RobotId, Robot> robots_;
  metrics::Counter& keyframes_;
  metrics::Counter& bytes_;
  metrics::Counter& corrupt_;
  metrics::Counter& duplicates_;
  metrics::Counter& stale_;
  metrics::Counter& refused_;
};

}  // namespace edgesplat::ingest
