// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/map/resident_map.hpp"

#include "common/log/log.hpp"
#include "common/map/delta_codec.hpp"

#include <utility>

namespace edgesplat::map {
namespace {

constexpr auto kMorePatience = std::chrono::milliseconds(500);
/// A hash may disagree once where the heartbeat was made between two steps of the server.
constexpr unsigned kDisagreements = 2;

DeltaGateConfig gate_config(const ResidentMapConfig& config) {
  DeltaGateConfig gate;
  gate.max_held_deltas = config.max_held_deltas;
  gate.max_held_bytes = config.max_held_bytes;
  return gate;
}

}  // namespace

ResidentMap::ResidentMap(const ResidentMapConfig& config)
    : config_(config),
      gate_(gate_config(config)),
      residency_(config.budget_bytes),
      published_(std::make_shared<const gaussian::GaussianCloud>()) {}

ApplyOutcome ResidentMap::apply(std::span<const std::byte> delta, HostTime now) {
  const auto header = decode_delta_header(delta);
  const std::lock_guard lock(mutex_);
  if (!header) {
    ++counters_.corrupt;
    return ApplyOutcome::kCorrupt;
  }
  if (header->robot != config_.robot) return refuse_foreign("it is for another robot", header->seq);
  const ApplyOutcome outcome = place(*header, delta, now);
  if (outcome == ApplyOutcome::kApplied) {
    while (const auto next = gate_.take_next()) {
      if (!apply_now(*next, now)) break;
    }
    evict_overflow();
    publish_where_due(now);
  }
  return outcome;
}

ApplyOutcome ResidentMap::refuse_foreign(const char* why, std::uint64_t seq) {
  if (counters_.foreign++ == 0)  // the others are counted
    EDGESPLAT_LOG_WARN("map", "delta refused", "why", why, "seq", seq);
  return ApplyOutcome::kForeign;
}

ApplyOutcome ResidentMap::place(const DeltaHeader& header, std::span<const std::byte> delta, HostTime now) {
  switch (gate_.place(header, delta, now)) {
    case DeltaGate::Verdict::kApply:
      return apply_now(delta, now) ? ApplyOutcome::kApplied : ApplyOutcome::kCorrupt;
    case DeltaGate::Verdict::kDuplicate:
      ++counters_.duplicates;
      return ApplyOutcome::kDuplicate;
    case DeltaGate::Verdict::kHeld:
      ++counters_.held;
      return ApplyOutcome::kHeld;
    case DeltaGate::Verdict::kOld:
      ++counters_.old_epoch;
      return ApplyOutcome::kOldEpoch;
    case DeltaGate::Verdict::kForeign:
      return refuse_foreign("it belongs to a map that this robot does not hold", header.seq);
    case DeltaGate::Verdict::kNeedsReset:
      break;
  }
  ++counters_.needs_reset;
  return ApplyOutcome::kNeedsReset;
}

bool ResidentMap::apply_now(std::span<const std::byte> bytes, HostTime now) {
  const auto delta = decode_delta(bytes);
  if (!delta || !state_.apply(*delta)) {
    ++counters_.corrupt;
    return false;
  }
  if (delta->header.base_seq == 0) {
    if (counters_.applied > 0) ++counters_.resets;
    more_waits_ = false;
    mapped_.clear();  // told again when the snapshot is whole
    disagreements_ = 0;
  }
  gate_.applied(delta->header, now);
  residency_.applied(*delta);
  if (const auto* replace = std::get_if<ChunkReplaceBody>(&delta->body)) {
    more_waits_ = replace->more;
    more_asked_.reset();
  }
  if (const auto* mapped = std::get_if<MappedBody>(&delta->body))
    mapped_.insert(mapped_.end(), mapped->keyframes.begin(), mapped->keyframes.end());
  changed_ = true;
  ++counters_.applied;
  return true;
}

void ResidentMap::evict_overflow() {
  for (const ChunkId& chunk : residency_.overflow(state_, bytes_each())) {
    residency_.dropped_alone(chunk, state_.drop_chunk(chunk));
    ++counters_.evicted_chunks;
    changed_ = true;
  }
}

void ResidentMap::server_at(const MapPosition& position, std::uint64_t hash, bool idle, HostTime now) {
  const std::lock_guard lock(mutex_);
  if (idle) gate_.server_at(position, now);
  const MapPosition& here = gate_.position();
  if (position.epoch != here.epoch || position.seq != here.seq || !residency_.in_step()) return;
  const bool agrees = hash == state_.hash();
  ++(agrees ? counters_.hash_agreed : counters_.hash_disagreed);
  disagreements_ = agrees ? 0 : disagreements_ + 1;
  if (disagreements_ >= kDisagreements) gate_.ask_snapshot();
}

void ResidentMap::robot_at(const Eigen::Vector3f& p_in_map_m) {
  const std::lock_guard lock(mutex_);
  residency_.robot_at(p_in_map_m);
}

std::vector<MapRequest> ResidentMap::requests(HostTime now) {
  const std::lock_guard lock(mutex_);
  std::vector<MapRequest> requests = gate_.requests(now);
  for (const MapRequest& request : requests)
    ++(request.kind == RequestKind::kResend ? counters_.resends_asked : counters_.snapshots_asked);
  std::vector<MapRequest> others = residency_.requests(state_, bytes_each(), now);
  const bool more_due = !more_asked_ || now - *more_asked_ >= kMorePatience;
  if (more_waits_ && more_due && residency_.has_room(state_, bytes_each())) {
    more_asked_ = now;
    others.emplace_back().kind = RequestKind::kMore;
  }
  for (MapRequest& request : others) {
    request.epoch = gate_.position().epoch;
    request.seq = gate_.position().seq;
    requests.push_back(std::move(request));
  }
  for (MapRequest& request : requests) {
    request.robot = config_.robot;
    request.robot_in_map_m = residency_.robot_in_map_m();
  }
  return requests;
}

void ResidentMap::publish_if_due(HostTime now) {
  const std::lock_guard lock(mutex_);
  publish_where_due(now);
}

void ResidentMap::publish_now(HostTime now) {
  const std::lock_guard lock(mutex_);
  publish(now);
}

void ResidentMap::publish_where_due(HostTime now) {
  const bool due = counters_.snapshots == 0 || now - last_publish_ >= from_seconds(config_.publish_period_s);
  if (due) publish(now);
}

void ResidentMap::publish(HostTime now) {
  if (!changed_) return;
  auto snapshot = std::make_shared<const gaussian::GaussianCloud>(dequantise(state_.rows()));
  changed_ = false;
  last_publish_ = now;
  ++counters_.snapshots;
  published_mapped_.insert(published_mapped_.end(), mapped_.begin(), mapped_.end());
  mapped_.clear();
  const std::lock_guard lock(published_mutex_);
  published_ = std::move(snapshot);
}

std::shared_ptr<const gaussian::GaussianCloud> ResidentMap::snapshot() const {
  const std::lock_guard lock(published_mutex_);
  return published_;
}

std::vector<std::uint32_t> ResidentMap::take_mapped() {
  const std::lock_guard lock(mutex_);
  return std::exchange(published_mapped_, {});
}

MapFromOdom ResidentMap::map_from_odom() const {
  return {};  // the server does not correct poses yet: both frames are one
}

MapPosition ResidentMap::position() const {
  const std::lock_guard lock(mutex_);
  return gate_.position();
}

std::uint64_t ResidentMap::map_hash() const {
  const std::lock_guard lock(mutex_);
  return state_.hash();
}

std::size_t ResidentMap::bytes_each() const {
  // The integers, and the floats of the published snapshot.
  constexpr std::size_t kFloats_bytes = 8 + 4 * (3 + 3 + 4 + 1 + 3) + 8;
  return state_.bytes_each() + kFloats_bytes + 4 * state_.rows().sh_rest_each();
}

ResidentMapCounters ResidentMap::counters() const {
  const std::lock_guard lock(mutex_);
  ResidentMapCounters counters = counters_;
  counters.gaussians = state_.size();
  counters.resident_bytes = state_.size() * bytes_each();
  counters.over_budget_bytes =
      counters.resident_bytes > config_.budget_bytes ? counters.resident_bytes - config_.budget_bytes : 0;
  counters.held_now = gate_.held();
  counters.absent_chunks = residency_.absent_chunks();
  return counters;
}

}  // namespace edgesplat::map
