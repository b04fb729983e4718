// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/app/mapping_stage.hpp"

#include "common/base/check.hpp"
#include "common/link/heartbeat.hpp"
#include "common/log/log.hpp"
#include "server/stream/map_uuid.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace edgesplat::app {
namespace {

constexpr double kBurst_s = 1.0;

/// Ids are never reused over restarts: the epoch is the upper 16 of the counter's 48 bits; and beyond all
/// that the saved maps know of, should the epoch be lost.
std::uint64_t first_counter(const Start& start) {
  std::uint64_t first = (static_cast<std::uint64_t>(start.epoch.value & 0xFFFFU) << 32U) + 1;
  for (const store::StoredMap& map : start.maps) first = std::max(first, map.next_id_counter);
  return first;
}

std::vector<OutgoingDelta> addressed(map::RobotId robot, std::vector<stream::Bytes> deltas) {
  std::vector<OutgoingDelta> out;
  out.reserve(deltas.size());
  for (stream::Bytes& bytes : deltas) out.push_back({robot, std::move(bytes)});
  return out;
}

}  // namespace

MappingStage::MappingStage(const config::ServerConfig& config, Start start, DeltaRoom room,
                           metrics::Registry& registry, const Clock& clock)
    : config_(config),
      epoch_(start.epoch),
      room_(std::move(room)),
      clock_(clock),
      ids_(config.instance_id, first_counter(start)),
      restored_(std::move(start.maps), std::move(start.unsaved)),
      keyframes_(registry.counter("map.keyframes")),
      keyframes_again_(registry.counter("map.keyframes_again")),
      gaussians_(registry.counter("map.gaussians")),
      steps_(registry.counter("map.steps")),
      bad_pictures_(registry.counter("map.bad_pictures")),
      deltas_(registry.counter("map.deltas")),
      delta_bytes_(registry.counter("map.delta_bytes")),
      keyframe_ms_(registry.histogram("map.keyframe_ms")),
      step_ms_(registry.histogram("map.step_ms")),
      requests_corrupt_(registry.counter("map.requests_corrupt")),
      resends_put_off_(registry.counter("map.resends_put_off")),
      restored_gaussians_(registry.counter("map.restored_gaussians")),
      copy_ms_(registry.histogram("store.copy_ms")) {}

std::vector<OutgoingDelta> MappingStage::handle(const ingest::IngestedKeyframe& keyframe) {
  const metrics::ScopedTimerMs timer(keyframe_ms_, clock_);
  restored_.heard(keyframe.robot, keyframe.session);
  begin_restored();
  RobotMap& robot = map_of(keyframe);
  if (robot.builder->has(keyframe.keyframe.id)) {
    keyframes_again_.add();  // it was in the log of an earlier server, which had not told the robot
    return {};
  }
  const std::size_t mapped_before = robot.builder->poses().size();
  const std::size_t added = robot.builder->add(keyframe.keyframe);
  if (robot.builder->poses().size() > mapped_before) {
    const std::uint32_t mapped[] = {keyframe.keyframe.id.value};
    robot.stream->mapped(mapped);
  }
  keyframes_.add();
  gaussians_.add(added);
  bad_pictures_.add(robot.builder->bad_pictures() -
                    std::exchange(robot.bad_pictures, robot.builder->bad_pictures()));
  EDGESPLAT_LOG_DEBUG("map", "keyframe mapped", "robot", keyframe.robot.value, "keyframe",
                      keyframe.keyframe.id.value, "points", keyframe.keyframe.points_in_body.size(), "added",
                      added, "total", robot.builder->engine().cloud().size());
  return publish(keyframe.robot, robot);
}

std::vector<OutgoingDelta> MappingStage::publish(map::RobotId robot, RobotMap& map) {
  map.last_publish = clock_.now();
  const mapping::EngineChanges changes = map.builder->take_changes();
  auto deltas = map.stream->publish(map.builder->engine().cloud(), changes.changed_rows, changes.removed,
                                    std::min(map.allowance.available(map.last_publish), room_(robot)));
  deltas_.add(deltas.size());
  for (const auto& delta : deltas) {
    delta_bytes_.add(delta.size());
    map.allowance.spend(delta.size());
  }
  return addressed(robot, std::move(deltas));
}

bool MappingStage::has_work() const {
  return restored_.has_keyframe() || std::any_of(maps_.begin(), maps_.end(), [this](const auto& entry) {
           return config_.optimise.enabled && entry.second.builder->has_work();
         });
}

std::vector<OutgoingDelta> MappingStage::work() {
  begin_restored();
  if (const auto unsaved = restored_.take_keyframe()) return handle(*unsaved);
  if (maps_.empty()) return {};
  auto turn = maps_.upper_bound(last_worked_);
  if (turn == maps_.end()) turn = maps_.begin();
  last_worked_ = turn->first;
  RobotMap& map = turn->second;
  if (config_.optimise.enabled && map.builder->has_work()) {
    const metrics::ScopedTimerMs timer(step_ms_, clock_);
    if (map.builder->step()) steps_.add();
  }
  if (clock_.now() - map.last_publish < from_seconds(config_.optimise.publish_period_s)) return {};
  return publish(turn->first, map);
}

MappingStage::RobotMap& MappingStage::map_of(const ingest::IngestedKeyframe& keyframe) {
  const auto found = maps_.find(keyframe.robot);
  if (found != maps_.end() && found->second.session == keyframe.session) return found->second;
  // The robot started anew: its odometry frame is another one, so nothing of the old map fits.
  if (found != maps_.end()) maps_.erase(found);
  RobotMap& fresh = begin(keyframe.robot, keyframe.session, stream::make_map_uuid());
  share(keyframe.robot, fresh);
  EDGESPLAT_LOG_INFO("map", "map begun", "robot", keyframe.robot.value, "epoch", epoch_.value);
  return fresh;
}

MappingStage::RobotMap& MappingStage::begin(map::RobotId robot, std::uint64_t session,
                                            const map::MapUuid& name) {
  auto builder = optimise::MapBuilder::create(config_.optimise.engine, ids_, clock_);
  EDGESPLAT_CHECK(builder.has_value(), "the configuration was checked");
  stream::DeltaStreamConfig stream;
  stream.robot = robot;
  stream.map = name;
  stream.epoch = epoch_;
  stream.max_rows = config_.delta_gaussians;
  RobotMap fresh{session, name, *std::move(builder), std::make_shared<stream::DeltaStream>(stream),
                 stream::ByteAllowance(config_.optimise.delta_bytes_per_s, kBurst_s, clock_.now())};
  return maps_.insert_or_assign(robot, std::move(fresh)).first->second;
}

void MappingStage::share(map::RobotId robot, const RobotMap& map) {
  const std::lock_guard lock(streams_mutex_);
  streams_[robot] = {map.session, map.stream};
}

std::shared_ptr<stream::DeltaStream> MappingStage::stream_of(map::RobotId robot,
                                                             std::uint64_t session) const {
  const std::lock_guard lock(streams_mutex_);
  const auto found = streams_.find(robot);
  // A robot that started anew has no map here yet: it is told when its first keyframe comes.
  if (found == streams_.end() || found->second.session != session) return nullptr;
  return found->second.stream;
}

std::vector<OutgoingDelta> MappingStage::answer(const link::Message& message) {
  const auto request = map::decode_map_request(message.bytes);
  if (!request || request->robot != message.robot) {
    requests_corrupt_.add();
    return {};
  }
  restored_.heard(message.robot, message.session);
  const auto stream = stream_of(message.robot, message.session);
  if (stream == nullptr) return {};
  if (request->kind == map::RequestKind::kResend && room_(message.robot) == 0) {
    resends_put_off_.add();
    return {};
  }
  EDGESPLAT_LOG_DEBUG("map", "map request", "robot", message.robot.value, "kind",
                      std::string(map::to_string(request->kind)), "seq", request->seq);
  return addressed(message.robot, stream->answer(*request, clock_.now()));
}

void MappingStage::take_heartbeat(const link::Message& message) {
  const auto heartbeat = link::decode_heartbeat(message.bytes);
  if (heartbeat) restored_.heard(message.robot, message.session);
  const auto stream = stream_of(message.robot, message.session);
  if (heartbeat && stream != nullptr) stream->confirmed(heartbeat->epoch, heartbeat->seq);
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

std::vector<const gaussian::GaussianCloud*> MappingStage::seeds() const {
  std::vector<const gaussian::GaussianCloud*> all;
  for (const auto& [robot, map] : maps_) {
    if (config_.optimise.engine.keep_seeds) all.push_back(&map.builder->engine().seeds());
  }
  return all;
}

}  // namespace edgesplat::app
