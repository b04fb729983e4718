// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/log/log.hpp"
#include "server/app/mapping_stage.hpp"

#include <utility>

/// What MappingStage takes from an earlier server and leaves to a later one.
namespace edgesplat::app {

void MappingStage::begin_restored() {
  while (const auto stored = restored_.take()) restore(*stored);
}

void MappingStage::restore(const store::StoredMap& stored) {
  const auto there = maps_.find(stored.robot);
  if (there != maps_.end()) return;  // it began anew meanwhile
  RobotMap& map = begin(stored.robot, stored.session, stored.map);
  std::vector<optimise::KeyframePose> poses;
  poses.reserve(stored.poses.size());
  for (const store::StoredPose& pose : stored.poses)
    poses.push_back({map::KeyframeId{pose.keyframe}, pose.version, pose.map_from_body});
  std::vector<std::uint32_t> mapped;
  mapped.reserve(stored.poses.size());
  for (const store::StoredPose& pose : stored.poses) mapped.push_back(pose.keyframe);
  const auto restored = map.builder->restore(stored.gaussians, std::move(poses));
  if (!restored) {
    EDGESPLAT_LOG_ERROR("map", "saved map not used: beginning anew", "robot", stored.robot.value, "why",
                        restored.error().context);
    maps_.erase(stored.robot);
    return;
  }
  // The robot gets it as a snapshot, nearest first and as fast as it confirms, whether or not it asks: what
  // is new meanwhile must not come before it.
  (void)map.builder->take_changes();
  map.stream->mapped(mapped);
  map::MapRequest everything;
  everything.robot = stored.robot;
  if (!stored.poses.empty())
    everything.robot_in_map_m = stored.poses.back().map_from_body.translation_m.cast<float>();
  (void)map.stream->answer(everything, clock_.now());
  map.saved_revision = map.revision();
  restored_gaussians_.add(*restored);
  share(stored.robot, map);
  EDGESPLAT_LOG_INFO("map", "map goes on", "robot", stored.robot.value, "epoch", epoch_.value, "gaussians",
                     *restored, "keyframes", stored.poses.size());
}

store::StoredMap MappingStage::copy_of(map::RobotId robot, RobotMap& map) {
  const metrics::ScopedTimerMs timer(copy_ms_, clock_);
  map.saved_revision = map.revision();
  store::StoredMap stored{map.name, robot, map.session, epoch_, ids_.next_counter(), {}, {}};
  for (const optimise::KeyframePose& pose : map.builder->poses())
    stored.poses.push_back({pose.keyframe.value, pose.version, pose.map_from_body});
  stored.gaussians = map.builder->engine().cloud();
  return stored;
}

std::vector<store::StoredMap> MappingStage::changed_maps() {
  std::vector<store::StoredMap> changed;
  for (auto& [robot, map] : maps_) {
    if (map.revision() != map.saved_revision) changed.push_back(copy_of(robot, map));
  }
  return changed;
}

std::vector<store::StoredMap> MappingStage::all_maps() {
  std::vector<store::StoredMap> all;
  all.reserve(maps_.size());
  for (auto& [robot, map] : maps_) all.push_back(copy_of(robot, map));
  return all;
}

}  // namespace edgesplat::app
