// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/app/unsaved_keyframes.hpp"

#include "common/log/log.hpp"
#include "common/map/keyframe_codec.hpp"

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <utility>

namespace edgesplat::app {
namespace {

/// Some 60 MB, and minutes of driving: far more than comes between two saves.
constexpr std::ptrdiff_t kMost = 512;

/// The keyframes of one robot's session that a map has.
struct Known {
  std::uint64_t session = 0;
  std::set<std::uint32_t> keyframes;
};

std::map<map::RobotId, Known> last_sessions(std::span<const store::LoggedKeyframe> logged,
                                            std::span<const store::StoredMap> saved) {
  std::map<map::RobotId, Known> known;
  for (const store::LoggedKeyframe& keyframe : logged) known[keyframe.robot].session = keyframe.session;
  for (const store::StoredMap& map : saved) {
    const auto of_robot = known.find(map.robot);
    if (of_robot == known.end() || of_robot->second.session != map.session) continue;
    for (const store::StoredPose& pose : map.poses) of_robot->second.keyframes.insert(pose.keyframe);
  }
  return known;
}

}  // namespace

std::vector<ingest::IngestedKeyframe> unsaved_keyframes(std::span<const store::LoggedKeyframe> logged,
                                                        std::span<const store::StoredMap> saved) {
  auto known = last_sessions(logged, saved);
  std::vector<ingest::IngestedKeyframe> unsaved;
  for (const store::LoggedKeyframe& entry : logged) {
    Known& of_robot = known.at(entry.robot);
    if (entry.session != of_robot.session) continue;
    auto keyframe = map::decode_keyframe(entry.bytes);
    if (!keyframe) {
      EDGESPLAT_LOG_WARN("store", "logged keyframe left out", "robot", entry.robot.value, "why",
                         keyframe.error().context);
      continue;
    }
    if (!of_robot.keyframes.insert(keyframe->id.value).second) continue;
    unsaved.push_back({entry.robot, entry.session, {}, std::move(*keyframe)});
  }
  if (std::ssize(unsaved) > kMost) {
    EDGESPLAT_LOG_WARN("store", "older logged keyframes left out", "keyframes", std::ssize(unsaved) - kMost);
    unsaved.erase(unsaved.begin(), unsaved.end() - kMost);
  }
  return unsaved;
}

}  // namespace edgesplat::app
