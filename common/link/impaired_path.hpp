// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/chunk_path.hpp"
#include "common/link/impairment.hpp"
#include "common/link/token_bucket.hpp"
#include "common/time/clock.hpp"

#include <deque>
#include <map>
#include <memory>
#include <random>
#include <vector>

namespace edgesplat::link {

/// A chunk path made worse on purpose (ImpairmentConfig): real chunks are held to a rate, delayed, lost,
/// repeated, overtaken and damaged on their way into `inner`. Bulk chunks pass the narrow place in order,
/// each when its last byte would have; urgent lanes go ahead of them and only use up its tokens, as small
/// packets do with fair queueing. Everything random comes from the seed. Single-owner.
class ImpairedPath final : public ChunkPath {
 public:
  ImpairedPath(const ImpairmentConfig& config, std::unique_ptr<ChunkPath> inner, const Clock& clock);

  WriteOutcome write(Lane lane, const ChunkHeader& header, std::span<const std::byte> payload) override;
  bool take(Lane lane, const ChunkHandler& handle) override { return inner_->take(lane, handle); }
  [[nodiscard]] bool has_reader(Lane lane) const override { return inner_->has_reader(lane); }
  void pump(HostTime now) override;
  [[nodiscard]] std::optional<HostTime> next_event() const override;

  [[nodiscard]] ImpairmentCounters counters() const { return counters_; }
  /// The true rate, for reports only: nothing that decides may ask.
  [[nodiscard]] std::optional<double> shaped_bytes_per_s() const { return bucket_.rate_at(clock_.now()); }

 private:
  struct Chunk {
    Lane lane = Lane::kKeyframe;
    ChunkHeader header;
    std::vector<std::byte> payload;
    HostTime since{};  ///< when it was written
  };
  [[nodiscard]] bool chance(double p);
  /// When it may pass the narrow place, once it is first in line.
  [[nodiscard]] HostTime ready_time(const Chunk& chunk) const;
  void pass_the_narrow_place(HostTime now);
  /// Past the narrow place at `t`: what happens to it on the rest of the way.
  void travel(Chunk chunk, HostTime t);
  void hand_on(HostTime now);

  static constexpr std::size_t kMaxTravelling = 4096;

  const ImpairmentConfig config_;
  const std::unique_ptr<ChunkPath> inner_;
  const Clock& clock_;
  TokenBucket bucket_;
  std::mt19937_64 random_;
  std::deque<Chunk> waiting_;  ///< in front of the narrow place
  std::size_t waiting_bytes_ = 0;
  HostTime narrow_place_free_{};               ///< when the last bulk chunk had passed
  std::multimap<HostTime, Chunk> travelling_;  ///< by the time of arrival
  ImpairmentCounters counters_;
};

}  // namespace edgesplat::link
