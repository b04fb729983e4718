// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/app/mapping_stage.hpp"

#include "common/log/log.hpp"
#include "server/stream/map_uuid.hpp"

#include <utility>

namespace edgesplat::app {
namespace {

/// Ids are never reused over restarts: the epoch is the upper 16 of the counter's 48 bits.
std::uint64_t first_counter(map::Epoch epoch) {
  return (static_cast<std::uint64_t>(epoch.value & 0xFFFFU) << 32U) + 1;
}

}  // namespace

MappingStage::MappingStage(const config::ServerConfig& config, map::Epoch epoch, metrics::Registry& registry,
                           const Clock& clock)
    : config_(config),
      epoch_(epoch),
      clock_(clock),
      ids_(config.instance_id, first_counter(epoch)),
      keyframes_(registry.counter("map.keyframes")),
      gaussians_(registry.counter("map.gaussians")),
      deltas_(registry.counter("map.deltas")),
      delta_bytes_(registry.counter("map.delta_bytes")),
      keyframe_ms_(registry.histogram("map.keyframe_ms")) {}

std::vector<std::vector<std::byte>> MappingStage::handle(const ingest::IngestedKeyframe& keyframe) {
  const metrics::ScopedTimerMs timer(keyframe_ms_, clock_);
  RobotMap& robot = map_of(keyframe);
  const optimise::MapChange change = robot.builder.add(keyframe.keyframe);
  auto deltas = robot.stream.add(change.added, change.chunks);
  if (!deltas) {  // a bug of ours: what was seeded must be encodable
    EDGESPLAT_LOG_ERROR("map", "delta not encoded", "why", deltas.error().context);
    return {};
  }
  keyframes_.add();
  gaussians_.add(change.added.size());
  deltas_.add(deltas->size());
  for (const auto& delta : *deltas) delta_bytes_.add(delta.size());
  publish_status(keyframe.robot, robot);
  EDGESPLAT_LOG_DEBUG("map", "keyframe mapped", "robot", keyframe.robot.value, "keyframe",
                      keyframe.keyframe.id.value, "points", keyframe.keyframe.points_in_body.size(), "added",
                      change.added.size(), "total", robot.builder.gaussians().size());
  return std::move(*deltas);
}

MappingStage::RobotMap& MappingStage::map_of(const ingest::IngestedKeyframe& keyframe) {
  const auto found = maps_.find(keyframe.robot);
  if (found != maps_.end() && found->second.session == keyframe.session) return found->second;
  // The robot started anew: its odometry frame is another one, so nothing of the old map fits.
  if (found != maps_.end()) maps_.erase(found);
  RobotMap fresh{
      keyframe.session, optimise::MapBuilder(config_.seed, ids_),
      stream::DeltaStream(keyframe.robot, stream::make_map_uuid(), epoch_, config_.delta_gaussians)};
  EDGESPLAT_LOG_INFO("map", "map begun", "robot", keyframe.robot.value, "epoch", epoch_.value);
  return maps_.emplace(keyframe.robot, std::move(fresh)).first->second;
}

void MappingStage::publish_status(map::RobotId robot, const RobotMap& map) {
  const MapStatus status{robot, epoch_, map.stream.seq(), map.builder.map_hash(),
                         map.builder.gaussians().size()};
  const std::lock_guard lock(status_mutex_);
  status_[robot] = status;
}

std::vector<MapStatus> MappingStage::status() const {
  const std::lock_guard lock(status_mutex_);
  std::vector<MapStatus> all;
  for (const auto& [robot, status] : status_) all.push_back(status);
  return all;
}

}  // namespace edgesplat::app
