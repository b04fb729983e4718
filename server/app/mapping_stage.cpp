// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/app/mapping_stage.hpp"

#include "common/log/log.hpp"
#include "server/stream/map_uuid.hpp"

#include <string>
#include <utility>

namespace edgesplat::app {
namespace {

/// Most bytes of deltas made at a time, about.
constexpr std::size_t kDeltaBudget_bytes = std::size_t{1} << 20U;

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
      keyframe_ms_(registry.histogram("map.keyframe_ms")),
      requests_corrupt_(registry.counter("map.requests_corrupt")) {}

std::vector<std::vector<std::byte>> MappingStage::handle(const ingest::IngestedKeyframe& keyframe) {
  const metrics::ScopedTimerMs timer(keyframe_ms_, clock_);
  RobotMap& robot = map_of(keyframe);
  const optimise::MapChange change = robot.builder.add(keyframe.keyframe);
  keyframes_.add();
  gaussians_.add(change.changed_rows.size());
  EDGESPLAT_LOG_DEBUG("map", "keyframe mapped", "robot", keyframe.robot.value, "keyframe",
                      keyframe.keyframe.id.value, "points", keyframe.keyframe.points_in_body.size(), "added",
                      change.changed_rows.size(), "total", robot.builder.gaussians().size());
  return publish(robot, change.changed_rows);
}

std::vector<std::vector<std::byte>> MappingStage::pump(map::RobotId robot) {
  const auto found = maps_.find(robot);
  if (found == maps_.end()) return {};
  return publish(found->second, {});
}

std::vector<std::vector<std::byte>> MappingStage::publish(RobotMap& robot,
                                                          std::span<const std::uint32_t> changed_rows) {
  auto deltas = robot.stream->publish(robot.builder.gaussians(), changed_rows, {}, kDeltaBudget_bytes);
  deltas_.add(deltas.size());
  for (const auto& delta : deltas) delta_bytes_.add(delta.size());
  return deltas;
}

std::vector<std::vector<std::byte>> MappingStage::answer(const link::Message& message) {
  const auto request = map::decode_map_request(message.bytes);
  if (!request || request->robot != message.robot) {
    requests_corrupt_.add();
    return {};
  }
  std::shared_ptr<stream::DeltaStream> stream;
  {
    const std::lock_guard lock(streams_mutex_);
    const auto found = streams_.find(message.robot);
    // A robot that started anew has no map here yet: it is told when its first keyframe comes.
    if (found == streams_.end() || found->second.session != message.session) return {};
    stream = found->second.stream;
  }
  EDGESPLAT_LOG_DEBUG("map", "map request", "robot", message.robot.value, "kind",
                      std::string(map::to_string(request->kind)), "seq", request->seq);
  return stream->answer(*request, clock_.now());
}

MappingStage::RobotMap& MappingStage::map_of(const ingest::IngestedKeyframe& keyframe) {
  const auto found = maps_.find(keyframe.robot);
  if (found != maps_.end() && found->second.session == keyframe.session) return found->second;
  // The robot started anew: its odometry frame is another one, so nothing of the old map fits.
  if (found != maps_.end()) maps_.erase(found);
  stream::DeltaStreamConfig stream;
  stream.robot = keyframe.robot;
  stream.map = stream::make_map_uuid();
  stream.epoch = epoch_;
  stream.max_rows = config_.delta_gaussians;
  RobotMap fresh{keyframe.session, optimise::MapBuilder(config_.seed, ids_),
                 std::make_shared<stream::DeltaStream>(stream)};
  {
    const std::lock_guard lock(streams_mutex_);
    streams_[keyframe.robot] = {keyframe.session, fresh.stream};
  }
  EDGESPLAT_LOG_INFO("map", "map begun", "robot", keyframe.robot.value, "epoch", epoch_.value);
  return maps_.emplace(keyframe.robot, std::move(fresh)).first->second;
}

std::vector<MapStatus> MappingStage::status() const {
  const std::lock_guard lock(streams_mutex_);
  std::vector<MapStatus> all;
  for (const auto& [robot, shared] : streams_) {
    const stream::StreamPosition at = shared.stream->position();
    all.push_back({robot, epoch_, at.seq, at.map_hash, at.gaussians});
  }
  return all;
}

}  // namespace edgesplat::app
