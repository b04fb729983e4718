// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/impaired_path.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::link {

ImpairedPath::ImpairedPath(const ImpairmentConfig& config, std::unique_ptr<ChunkPath> inner,
                           const Clock& clock)
    : config_(config),
      inner_(std::move(inner)),
      clock_(clock),
      bucket_(clock.now(), config.shape_at_s, config.shape_bytes_per_s, config.burst_bytes),
      random_(config.seed) {}

bool ImpairedPath::chance(double p) {
  return std::uniform_real_distribution<double>(0.0, 1.0)(random_) < p;
}

WriteOutcome ImpairedPath::write(Lane lane, const ChunkHeader& header, std::span<const std::byte> payload) {
  const HostTime now = clock_.now();
  pump(now);
  Chunk chunk{lane, header, {payload.begin(), payload.end()}, now};
  if (urgent(lane)) {
    if (bucket_.rate_at(now) == 0.0) {
      ++counters_.lost;
      return WriteOutcome::kWritten;
    }
    bucket_.take(payload.size(), now, waiting_.empty() ? 0 : waiting_.front().payload.size());
    travel(std::move(chunk), now);
  } else {
    const bool full = !waiting_.empty() && waiting_bytes_ + payload.size() > config_.queue_bytes;
    if (full || travelling_.size() >= kMaxTravelling) {
      ++counters_.held_back;
      return WriteOutcome::kBusy;
    }
    waiting_bytes_ += payload.size();
    waiting_.push_back(std::move(chunk));
  }
  pump(now);
  return WriteOutcome::kWritten;
}

void ImpairedPath::pump(HostTime now) {
  pass_the_narrow_place(now);
  hand_on(now);
}

HostTime ImpairedPath::ready_time(const Chunk& chunk) const {
  return bucket_.ready_at(chunk.payload.size(), std::max(chunk.since, narrow_place_free_));
}

void ImpairedPath::pass_the_narrow_place(HostTime now) {
  while (!waiting_.empty()) {
    const std::size_t bytes = waiting_.front().payload.size();
    const HostTime ready = ready_time(waiting_.front());
    if (ready > now) return;
    bucket_.take(bytes, ready);
    narrow_place_free_ = ready;
    waiting_bytes_ -= bytes;
    Chunk chunk = std::move(waiting_.front());
    waiting_.pop_front();
    travel(std::move(chunk), ready);
  }
}

void ImpairedPath::travel(Chunk chunk, HostTime t) {
  if (chance(config_.loss)) {
    ++counters_.lost;
    return;
  }
  if (chance(config_.flip_bits) && !chunk.payload.empty()) {
    ++counters_.flipped;
    const auto bit = std::uniform_int_distribution<std::size_t>(0, chunk.payload.size() * 8 - 1)(random_);
    chunk.payload[bit / 8] ^= std::byte{1} << (bit % 8);
  }
  nanoseconds delay = from_seconds(config_.delay_ms / 1e3);
  if (chance(config_.duplicate)) {
    ++counters_.duplicated;
    travelling_.emplace(t + delay, chunk);
  }
  if (chance(config_.reorder)) {
    ++counters_.reordered;
    delay += from_seconds(std::uniform_real_distribution<double>(0.0, 1e-3)(random_) * config_.reorder_ms);
  }
  travelling_.emplace(t + delay, std::move(chunk));
}

void ImpairedPath::hand_on(HostTime now) {
  while (!travelling_.empty() && travelling_.begin()->first <= now) {
    const Chunk& chunk = travelling_.begin()->second;
    // A full inner path holds everything back; a refused chunk is gone, as on any network.
    if (inner_->write(chunk.lane, chunk.header, chunk.payload) == WriteOutcome::kBusy) return;
    travelling_.erase(travelling_.begin());
  }
}

std::optional<HostTime> ImpairedPath::next_event() const {
  std::optional<HostTime> next;
  if (!travelling_.empty()) next = travelling_.begin()->first;
  if (!waiting_.empty()) {
    const HostTime ready = ready_time(waiting_.front());
    if (ready != HostTime::max()) next = next ? std::min(*next, ready) : ready;
  }
  return next;
}

}  // namespace edgesplat::link
