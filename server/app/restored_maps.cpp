// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/app/restored_maps.hpp"

#include "common/log/log.hpp"

#include <utility>

namespace edgesplat::app {

RestoredMaps::RestoredMaps(std::vector<store::StoredMap> maps, std::vector<ingest::IngestedKeyframe> unsaved)
    : unsaved_(std::move(unsaved)) {
  for (store::StoredMap& map : maps) {
    const map::RobotId robot = map.robot;
    waiting_.emplace(robot, std::move(map));
  }
}

void RestoredMaps::heard(map::RobotId robot, std::uint64_t session) {
  const std::lock_guard lock(mutex_);
  hear_keyframes(robot, session);
  const auto found = waiting_.find(robot);
  if (found == waiting_.end()) return;
  if (found->second.session == session) {
    heard_.push_back(std::move(found->second));
  } else {
    EDGESPLAT_LOG_INFO("map", "the robot started anew: its saved map stays on the disk", "robot",
                       robot.value);
  }
  waiting_.erase(found);
}

void RestoredMaps::hear_keyframes(map::RobotId robot, std::uint64_t session) {
  std::vector<ingest::IngestedKeyframe> others;
  for (ingest::IngestedKeyframe& keyframe : unsaved_) {
    if (keyframe.robot != robot) {
      others.push_back(std::move(keyframe));
    } else if (keyframe.session == session) {
      heard_keyframes_.push_back(std::move(keyframe));
    }
  }
  unsaved_ = std::move(others);
}

std::optional<ingest::IngestedKeyframe> RestoredMaps::take_keyframe() {
  const std::lock_guard lock(mutex_);
  if (heard_keyframes_.empty() || !heard_.empty()) return std::nullopt;
  std::optional<ingest::IngestedKeyframe> keyframe = std::move(heard_keyframes_.front());
  heard_keyframes_.pop_front();
  return keyframe;
}

bool RestoredMaps::has_keyframe() const {
  const std::lock_guard lock(mutex_);
  return !heard_keyframes_.empty();
}

std::optional<store::StoredMap> RestoredMaps::take() {
  const std::lock_guard lock(mutex_);
  if (heard_.empty()) return std::nullopt;
  std::optional<store::StoredMap> map = std::move(heard_.back());
  heard_.pop_back();
  return map;
}

}  // namespace edgesplat::app
