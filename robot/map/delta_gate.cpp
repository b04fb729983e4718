// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/map/delta_gate.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::map {
namespace {

constexpr std::size_t kFormerMaps = 8;
constexpr double kTailPatience = 3.0;
constexpr std::size_t kMaxGaps = 8;  // asked for at a time

}  // namespace

bool DeltaGate::begins_anew(const DeltaHeader& header) const {
  return !started_ || header.epoch > position_.epoch || header.map != map_;
}

DeltaGate::Verdict DeltaGate::place(const DeltaHeader& header, std::span<const std::byte> bytes,
                                    HostTime now) {
  if (started_ && header.epoch < position_.epoch) return Verdict::kOld;
  if (begins_anew(header)) {
    if (std::find(former_maps_.begin(), former_maps_.end(), header.map) != former_maps_.end())
      return Verdict::kOld;
    if (header.base_seq == 0) return Verdict::kApply;
    wants_snapshot_ = true;
    return started_ && header.epoch == position_.epoch ? Verdict::kForeign : Verdict::kNeedsReset;
  }
  if (header.seq <= position_.seq || held_.contains(header.seq)) return Verdict::kDuplicate;
  // One that begins with an empty map stands for all before it.
  if (header.base_seq != 0 && header.base_seq > position_.seq) return hold(header, bytes, now);
  return Verdict::kApply;
}

DeltaGate::Verdict DeltaGate::hold(const DeltaHeader& header, std::span<const std::byte> bytes,
                                   HostTime now) {
  note_gap(now);
  if (held_.size() >= config_.max_held_deltas || held_bytes_ + bytes.size() > config_.max_held_bytes)
    return Verdict::kNeedsReset;
  held_.emplace(header.seq, Held{header, {bytes.begin(), bytes.end()}, now, {}});
  held_bytes_ += bytes.size();
  return Verdict::kHeld;
}

void DeltaGate::applied(const DeltaHeader& header, HostTime now) {
  if (begins_anew(header)) {
    if (started_ && header.map != map_) {
      former_maps_.push_back(map_);
      if (former_maps_.size() > kFormerMaps) former_maps_.pop_front();
    }
    held_.clear();
    held_bytes_ = 0;
    server_seq_ = 0;
  }
  started_ = true;
  newer_epoch_ = false;
  map_ = header.map;
  position_ = {header.epoch, header.seq};
  if (header.base_seq == 0) {
    wants_snapshot_ = false;
    snapshot_asked_.reset();
  }
  forget_settled();
  tail_asked_.reset();
  gap_since_.reset();
  if (!held_.empty() || server_seq_ > position_.seq) gap_since_ = now;
}

void DeltaGate::forget_settled() {
  while (!held_.empty() && held_.begin()->first <= position_.seq) {
    held_bytes_ -= held_.begin()->second.bytes.size();
    held_.erase(held_.begin());
  }
}

std::optional<std::vector<std::byte>> DeltaGate::take_next() {
  if (held_.empty() || held_.begin()->second.header.base_seq > position_.seq) return std::nullopt;
  auto node = held_.extract(held_.begin());
  held_bytes_ -= node.mapped().bytes.size();
  return std::move(node.mapped().bytes);
}

void DeltaGate::note_gap(HostTime now) {
  if (!gap_since_) gap_since_ = now;
}

void DeltaGate::server_at(const MapPosition& position, HostTime now) {
  if (started_ && position.epoch < position_.epoch) return;
  if (!started_ || position.epoch > position_.epoch) {
    if (position.seq == 0) return;
    note_gap(now);
    newer_epoch_ = true;
    return;
  }
  server_seq_ = position.seq;
  if (server_seq_ > position_.seq) note_gap(now);
}

MapRequest DeltaGate::request_of(RequestKind kind, std::uint64_t after, std::uint64_t until) const {
  MapRequest request;
  request.kind = kind;
  request.epoch = position_.epoch;
  request.seq = after;
  request.until_seq = until;
  return request;
}

bool DeltaGate::snapshot_due(HostTime now) {
  if (gap_since_) {
    const nanoseconds gap = now - *gap_since_;
    if (gap >= from_seconds(config_.snapshot_after_s)) wants_snapshot_ = true;
    if (newer_epoch_ && gap >= from_seconds(kTailPatience * config_.resend_after_s)) wants_snapshot_ = true;
  }
  if (!wants_snapshot_) return false;
  return !snapshot_asked_ || now - *snapshot_asked_ >= from_seconds(config_.snapshot_again_after_s);
}

bool DeltaGate::resend_due(HostTime since, double patience_s, std::optional<HostTime>& asked,
                           HostTime now) const {
  if (now - since < from_seconds(patience_s)) return false;
  if (asked && now - *asked < from_seconds(2 * config_.resend_after_s)) return false;
  asked = now;
  return true;
}

std::vector<MapRequest> DeltaGate::requests(HostTime now) {
  if (snapshot_due(now)) {
    snapshot_asked_ = now;
    return {request_of(RequestKind::kSnapshot, position_.seq, 0)};
  }
  if (wants_snapshot_ || !gap_since_) return {};
  std::vector<MapRequest> requests;
  std::uint64_t last = position_.seq;
  for (auto& [seq, held] : held_) {
    const bool gap = seq > last + 1;
    if (gap && requests.size() < kMaxGaps && resend_due(held.since, config_.resend_after_s, held.asked, now))
      requests.push_back(request_of(RequestKind::kResend, last, seq - 1));
    last = seq;
  }
  // Nothing came after what is missing at the end: it may be on its way still.
  const double tail_patience_s = kTailPatience * config_.resend_after_s;
  if (server_seq_ > last && resend_due(*gap_since_, tail_patience_s, tail_asked_, now))
    requests.push_back(request_of(RequestKind::kResend, last, server_seq_));
  return requests;
}

}  // namespace edgesplat::map
