// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/app/server.hpp"

#include "common/link/heartbeat.hpp"
#include "common/log/log.hpp"

#include <utility>

namespace edgesplat::app {

Server::Server(const config::ServerConfig& config, map::Epoch epoch, link::Transport& transport,
               metrics::Registry& registry, const Clock& clock)
    : config_(config),
      transport_(transport),
      clock_(clock),
      ingest_(registry, config.max_robots),
      stage_(config, epoch, registry, clock),
      keyframe_to_delta_ms_(registry.histogram("server.keyframe_to_delta_ms")),
      deltas_refused_(registry.counter("server.deltas_refused")),
      last_keyframe_ns_(to_ns(clock.now())),
      // A full queue blocks the receiver; its inbox and DDS fill up then, and the robots shed what is oldest.
      queue_({config.queue_keyframes}, thread::Overflow::kBlock) {
  mapper_.emplace(thread::Worker::consume<Job>("map", queue_, [this](const Job& job) { do_job(job); }));
  receiver_.emplace("ingest", [this](const std::stop_token& stop) { return receive_step(stop); });
}

Server::~Server() {
  finish(nanoseconds(0));
}

bool Server::receive_step(const std::stop_token& stop) {
  const auto message = transport_.receive(std::chrono::milliseconds(100));
  if (stop.stop_requested()) return false;
  if (!message) return !transport_.finished();
  if (message->lane == link::Lane::kRequest) {
    send(message->robot, stage_.answer(*message));
    (void)queue_.push(Job(message->robot));
  }
  if (message->lane != link::Lane::kKeyframe && message->lane != link::Lane::kSpool)
    return true;  // the robots' heartbeats: nothing here depends on them yet
  const HostTime received = clock_.now();
  last_keyframe_ns_ = to_ns(received);
  auto keyframe = ingest_.take(*message, received);
  if (keyframe) (void)queue_.push(Job(std::move(*keyframe)));
  return true;
}

void Server::send(map::RobotId robot, std::vector<std::vector<std::byte>> deltas) {
  for (auto& delta : deltas) {
    if (!transport_.send(link::Lane::kDelta, robot, std::move(delta))) deltas_refused_.add();
  }
}

void Server::do_job(const Job& job) {
  if (const auto* keyframe = std::get_if<ingest::IngestedKeyframe>(&job)) {
    map_keyframe(*keyframe);
  } else {
    const map::RobotId robot = std::get<map::RobotId>(job);
    send(robot, stage_.pump(robot));
  }
}

void Server::map_keyframe(const ingest::IngestedKeyframe& keyframe) {
  send(keyframe.robot, stage_.handle(keyframe));
  keyframe_to_delta_ms_.record(to_seconds(clock_.now() - keyframe.received) * 1e3);
}

void Server::send_heartbeats() {
  const link::LinkCounters counters = transport_.counters();
  const auto& down = counters[static_cast<std::size_t>(link::Lane::kDelta)];
  for (const MapStatus& status : stage_.status()) {
    link::Heartbeat heartbeat;
    heartbeat.epoch = status.epoch;
    heartbeat.seq = status.seq;
    heartbeat.map_hash = status.map_hash;
    heartbeat.queued_messages = static_cast<std::uint32_t>(down.queued_messages + down.flying_messages);
    heartbeat.queued_bytes = down.queued_bytes + down.flying_bytes;
    (void)transport_.send(link::Lane::kHeartbeat, status.robot, link::encode_heartbeat(heartbeat));
  }
}

nanoseconds Server::idle() const {
  return clock_.now() - host_time_from_ns(last_keyframe_ns_.load());
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
    if (!transport_.drain(link::Lane::kDelta, patience) && patience > nanoseconds(0)) {
      EDGESPLAT_LOG_WARN("server", "some deltas were not acknowledged before the end");
    }
  }
}

}  // namespace edgesplat::app
