// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/map/delta_gate.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::map {
namespace {

constexpr std::size_t kFormerMaps = 8;
constexpr double kTailPatience = 3.0;

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
    return Verdict::kNeedsReset;
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
  held_.emplace(header.seq, Held{header, {bytes.begin(), bytes.end()}});
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
  resend_asked_.reset();
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

std::optional<MapRequest> DeltaGate::request(HostTime now) {
  const nanoseconds gap = gap_since_ ? now - *gap_since_ : nanoseconds(0);
  // Nothing came after what is missing: it may be on its way still.
  const double patience_s = (held_.empty() ? kTailPatience : 1.0) * config_.resend_after_s;
  const bool overdue = gap_since_ && gap >= from_seconds(patience_s);
  if (gap_since_ && gap >= from_seconds(config_.snapshot_after_s)) wants_snapshot_ = true;
  if (overdue && newer_epoch_) wants_snapshot_ = true;
  MapRequest request;
  request.epoch = position_.epoch;
  request.seq = position_.seq;
  if (wants_snapshot_) {
    if (snapshot_asked_ && now - *snapshot_asked_ < from_seconds(config_.snapshot_again_after_s))
      return std::nullopt;
    snapshot_asked_ = now;
    request.kind = RequestKind::kSnapshot;
    return request;
  }
  if (!overdue) return std::nullopt;
  if (resend_asked_ && now - *resend_asked_ < from_seconds(2 * config_.resend_after_s)) return std::nullopt;
  resend_asked_ = now;
  request.kind = RequestKind::kResend;
  request.until_seq = held_.empty() ? server_seq_ : held_.begin()->first - 1;
  return request;
}

}  // namespace edgesplat::map
