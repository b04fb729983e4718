// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/app/server.hpp"

#include "common/link/heartbeat.hpp"
#include "common/log/log.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::app {
namespace {

constexpr nanoseconds kIdleWait = std::chrono::milliseconds(50);
constexpr std::size_t kMostWaiting_bytes = 64 * 1024;  // for one robot: half a second at 1 Mbit/s

}  // namespace

Server::Server(const config::ServerConfig& config, Start start, link::Transport& transport,
               metrics::Registry& registry, const Clock& clock)
    : config_(config),
      transport_(transport),
      clock_(clock),
      recorder_(start.recorder),
      ingest_(registry, config.max_robots),
      stage_(
          config, std::move(start), [this](map::RobotId robot) { return delta_room(robot); }, registry,
          clock),
      keyframe_to_delta_ms_(registry.histogram("server.keyframe_to_delta_ms")),
      deltas_refused_(registry.counter("server.deltas_refused")),
      last_keyframe_ns_(to_ns(clock.now())),
      received_round_ns_(to_ns(clock.now())),
      mapped_round_ns_(to_ns(clock.now())),
      last_save_(clock.now()),
      // A full queue blocks the receiver; its inbox and DDS fill up then, and the robots shed what is oldest.
      queue_({config.queue_keyframes}, thread::Overflow::kBlock) {
  mapper_.emplace("map", [this](const std::stop_token&) { return map_step(); });
  receiver_.emplace("ingest", [this](const std::stop_token& stop) { return receive_step(stop); });
}

Server::~Server() {
  finish(nanoseconds(0));
}

bool Server::receive_step(const std::stop_token& stop) {
  received_round_ns_ = to_ns(clock_.now());
  auto message = transport_.receive(std::chrono::milliseconds(100));
  if (stop.stop_requested()) return false;
  if (!message) return !transport_.finished();
  switch (message->lane) {
    case link::Lane::kKeyframe:
    case link::Lane::kSpool:
      take_keyframe(*std::move(message));
      break;
    case link::Lane::kRequest:
      send(stage_.answer(*message));
      break;
    case link::Lane::kHeartbeat:
      hear(message->robot);
      stage_.take_heartbeat(*message);
      break;
    default:
      break;
  }
  return true;
}

void Server::hear(map::RobotId robot) {
  const std::lock_guard lock(heard_mutex_);
  if (heard_.size() < config_.max_robots) heard_.insert(robot);
}

void Server::take_keyframe(link::Message message) {
  const HostTime received = clock_.now();
  last_keyframe_ns_ = to_ns(received);
  auto keyframe = ingest_.take(message, received);
  if (!keyframe) return;
  if (recorder_ != nullptr) recorder_->keyframe({message.robot, message.session, std::move(message.bytes)});
  (void)queue_.push(std::move(*keyframe));
}

bool Server::map_step() {
  mapped_round_ns_ = to_ns(clock_.now());
  // Keyframes first; between them the maps are made better, and with nothing to do the thread sleeps until
  // something may be due to be sent.
  auto keyframe = stage_.has_work() ? queue_.try_pop() : queue_.pop_for(kIdleWait);
  if (keyframe) {
    send(stage_.handle(*keyframe));
    keyframe_to_delta_ms_.record(to_seconds(clock_.now() - keyframe->received) * 1e3);
  } else if (queue_.finished()) {
    return false;
  } else {
    send(stage_.work());
  }
  save_if_due();
  return true;
}

std::size_t Server::delta_room(map::RobotId robot) const {
  return kMostWaiting_bytes -
         std::min(kMostWaiting_bytes, transport_.waiting_bytes(link::Lane::kDelta, robot));
}

void Server::save_if_due() {
  if (recorder_ == nullptr || recorder_->saving()) return;
  const HostTime now = clock_.now();
  if (now - last_save_ < from_seconds(config_.store.save_period_s)) return;
  last_save_ = now;
  for (store::StoredMap& map : stage_.changed_maps()) (void)recorder_->map(std::move(map));
}

void Server::send(std::vector<OutgoingDelta> deltas) {
  for (OutgoingDelta& delta : deltas) {
    if (!transport_.send(link::Lane::kDelta, delta.robot, std::move(delta.bytes))) deltas_refused_.add();
  }
}

void Server::send_heartbeats() {
  const link::LinkCounters counters = transport_.counters();
  const auto& down = counters[link::index_of(link::Lane::kDelta)];
  std::set<map::RobotId> without_map;
  {
    const std::lock_guard lock(heard_mutex_);
    without_map = heard_;
  }
  for (const MapStatus& status : stage_.status()) {
    send_heartbeat(status, down);
    without_map.erase(status.robot);
  }
  for (const map::RobotId robot : without_map) {
    MapStatus none;
    none.robot = robot;
    send_heartbeat(none, down);
  }
}

void Server::send_heartbeat(const MapStatus& status, const link::LaneCounters& down) {
  link::Heartbeat heartbeat;
  heartbeat.epoch = status.epoch;
  heartbeat.seq = status.seq;
  heartbeat.map_hash = status.map_hash;
  heartbeat.queued_messages = static_cast<std::uint32_t>(down.queued_messages + down.flying_messages);
  heartbeat.queued_bytes = down.queued_bytes + down.flying_bytes;
  (void)transport_.send(link::Lane::kHeartbeat, status.robot, link::encode_heartbeat(heartbeat));
}

nanoseconds Server::idle() const {
  return clock_.now() - host_time_from_ns(last_keyframe_ns_.load());
}

nanoseconds Server::without_progress() const {
  const std::int64_t slower_ns = std::min(received_round_ns_.load(), mapped_round_ns_.load());
  return clock_.now() - host_time_from_ns(slower_ns);
}

void Server::finish(nanoseconds patience) {
  if (receiver_) {
    receiver_->request_stop();
    receiver_->join();
    receiver_.reset();
  }
  queue_.close();
  if (mapper_) {
    mapper_->join();
    mapper_.reset();
    if (recorder_ != nullptr) recorder_->finish(stage_.all_maps());
    if (!transport_.drain(link::Lane::kDelta, patience) && patience > nanoseconds(0)) {
      EDGESPLAT_LOG_WARN("server", "some deltas were not acknowledged before the end");
    }
  }
}

}  // namespace edgesplat::app
