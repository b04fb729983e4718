// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/chunk_id.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <set>
#include <span>

namespace edgesplat::stream {

/// Which chunks the robot does not hold, which of them it waits for, and how much may be under way to it: it
/// asks for more when it has applied what came. Single-owner.
class ChunkPlan {
 public:
  /// `window_bytes`: sent and not yet confirmed, at least one part whatever its size.
  explicit ChunkPlan(std::size_t window_bytes) : window_bytes_(window_bytes) {}

  /// Everything anew: all of `chunks`, those nearest to the robot first.
  void restart(std::span<const map::ChunkId> chunks, const Eigen::Vector3f& robot_in_map_m);
  /// The robot gave a chunk up. False where that was known.
  bool release(const map::ChunkId& chunk);
  /// The robot wants a chunk that it gave up. False where it did not.
  bool fetch(const map::ChunkId& chunk);
  /// Nothing of this chunk may be sent except as a whole.
  [[nodiscard]] bool withheld(const map::ChunkId& chunk) const { return withheld_.contains(chunk); }

  [[nodiscard]] bool may_send() const { return !waiting_.empty() && under_way_bytes_ < window_bytes_; }
  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }
  [[nodiscard]] const std::deque<map::ChunkId>& queue() const { return waiting_; }
  /// The next chunk to send as a whole; no longer withheld.
  map::ChunkId take();
  void sent(std::uint64_t seq, std::size_t bytes);
  /// The robot has applied everything up to `seq`.
  void confirmed(std::uint64_t seq);

 private:
  struct Part {
    std::uint64_t seq;
    std::size_t bytes;
  };
  std::size_t window_bytes_;
  std::set<map::ChunkId> withheld_;
  std::deque<map::ChunkId> waiting_;  ///< of those
  std::deque<Part> under_way_;
  std::size_t under_way_bytes_ = 0;
};

}  // namespace edgesplat::stream
