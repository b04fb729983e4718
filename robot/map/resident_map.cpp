// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/map/resident_map.hpp"

#include "common/map/delta_codec.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::map {
namespace {

/// Memory of one Gaussian: id, 11 floats, anchor, SH, and about 56 bytes in the set of ids.
std::size_t bytes_each(const gaussian::GaussianCloud& cloud) {
  return 8 + 4 * 11 + 8 + 4 * cloud.sh_floats_each() + 56;
}

}  // namespace

ResidentMap::ResidentMap(const ResidentMapConfig& config)
    : config_(config), published_(std::make_shared<const gaussian::GaussianCloud>()) {}

ApplyOutcome ResidentMap::apply(std::span<const std::byte> delta, HostTime now) {
  const auto header = decode_delta_header(delta);
  const std::lock_guard lock(mutex_);
  if (!header || header->robot != config_.robot) {
    ++counters_.corrupt;
    return ApplyOutcome::kCorrupt;
  }
  const ApplyOutcome outcome = place(*header, delta);
  if (outcome == ApplyOutcome::kApplied) publish_where_due(now);
  return outcome;
}

ApplyOutcome ResidentMap::place(const DeltaHeader& header, std::span<const std::byte> delta) {
  if (started_ && header.epoch < position_.epoch) {
    ++counters_.old_epoch;
    return ApplyOutcome::kOldEpoch;
  }
  if (!started_ || header.epoch > position_.epoch) {
    if (header.base_seq != 0) {
      ++counters_.needs_reset;
      return ApplyOutcome::kNeedsReset;
    }
    reset(header);
  }
  if (header.map != map_uuid_) {
    ++counters_.corrupt;
    return ApplyOutcome::kCorrupt;
  }
  if (header.seq <= position_.seq || held_.contains(header.seq)) {
    ++counters_.duplicates;
    return ApplyOutcome::kDuplicate;
  }
  if (header.base_seq > position_.seq) return hold(header, delta);
  if (!apply_now(header, delta)) return ApplyOutcome::kCorrupt;
  apply_held();
  return ApplyOutcome::kApplied;
}

ApplyOutcome ResidentMap::hold(const DeltaHeader& header, std::span<const std::byte> delta) {
  if (held_.size() >= config_.max_held_deltas || held_bytes_ + delta.size() > config_.max_held_bytes) {
    ++counters_.needs_reset;
    return ApplyOutcome::kNeedsReset;
  }
  held_.emplace(header.seq, Held{header, {delta.begin(), delta.end()}});
  held_bytes_ += delta.size();
  ++counters_.held;
  return ApplyOutcome::kHeld;
}

void ResidentMap::apply_held() {
  while (!held_.empty() && held_.begin()->second.header.base_seq <= position_.seq) {
    const auto node = held_.extract(held_.begin());
    const Held& held = node.mapped();
    held_bytes_ -= held.bytes.size();
    if (held.header.seq > position_.seq && !apply_now(held.header, held.bytes)) return;
  }
}

bool ResidentMap::apply_now(const DeltaHeader& header, std::span<const std::byte> bytes) {
  const auto delta = decode_add(bytes);
  const bool fits = delta && (cloud_.size() == 0 || cloud_.sh_degree == delta->gaussians.sh_degree);
  if (!fits) {
    ++counters_.corrupt;
    return false;
  }
  const auto& added = delta->gaussians;
  cloud_.sh_degree = added.sh_degree;
  for (std::size_t row = 0; row < added.size(); ++row) {
    if (!resident_.insert(added.ids[row]).second) {
      ++counters_.duplicate_ids;
      continue;
    }
    cloud_.append_row(added, row);
    hash_.add(delta->chunks[row], record_digest(added, row));
  }
  position_.seq = header.seq;
  changed_ = true;
  ++counters_.applied;
  return true;
}

void ResidentMap::reset(const DeltaHeader& header) {
  if (started_) ++counters_.resets;
  started_ = true;
  cloud_ = {};
  resident_.clear();
  hash_.clear();
  held_.clear();
  held_bytes_ = 0;
  map_uuid_ = header.map;
  position_ = {header.epoch, 0};
  changed_ = true;
}

void ResidentMap::publish_if_due(HostTime now) {
  const std::lock_guard lock(mutex_);
  publish_where_due(now);
}

void ResidentMap::publish_where_due(HostTime now) {
  const bool due = counters_.snapshots == 0 || now - last_publish_ >= from_seconds(config_.publish_period_s);
  if (!changed_ || !due) return;
  auto snapshot = std::make_shared<const gaussian::GaussianCloud>(cloud_);
  changed_ = false;
  last_publish_ = now;
  ++counters_.snapshots;
  const std::lock_guard lock(published_mutex_);
  published_ = std::move(snapshot);
}

std::shared_ptr<const gaussian::GaussianCloud> ResidentMap::snapshot() const {
  const std::lock_guard lock(published_mutex_);
  return published_;
}

MapFromOdom ResidentMap::map_from_odom() const {
  return {};  // the server does not correct poses yet: both frames are one
}

MapPosition ResidentMap::position() const {
  const std::lock_guard lock(mutex_);
  return position_;
}

std::uint64_t ResidentMap::map_hash() const {
  const std::lock_guard lock(mutex_);
  return hash_.value();
}

ResidentMapCounters ResidentMap::counters() const {
  const std::lock_guard lock(mutex_);
  ResidentMapCounters counters = counters_;
  counters.gaussians = cloud_.size();
  counters.resident_bytes = cloud_.size() * bytes_each(cloud_);
  counters.over_budget_bytes =
      counters.resident_bytes > config_.budget_bytes ? counters.resident_bytes - config_.budget_bytes : 0;
  counters.held_now = held_.size();
  return counters;
}

}  // namespace edgesplat::map
