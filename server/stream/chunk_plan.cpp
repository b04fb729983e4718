// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/stream/chunk_plan.hpp"

#include "common/base/check.hpp"

#include <algorithm>
#include <tuple>
#include <vector>

namespace edgesplat::stream {
namespace {

float distance2_m2(const map::ChunkId& chunk, const Eigen::Vector3f& p_in_map_m) {
  const Eigen::Vector3f cell(static_cast<float>(chunk.x), static_cast<float>(chunk.y),
                             static_cast<float>(chunk.z));
  return (map::kChunkEdge_m * (cell + Eigen::Vector3f::Constant(0.5F)) - p_in_map_m).squaredNorm();
}

}  // namespace

void ChunkPlan::restart(std::span<const map::ChunkId> chunks, const Eigen::Vector3f& robot_in_map_m) {
  withheld_ = {chunks.begin(), chunks.end()};
  waiting_ = {chunks.begin(), chunks.end()};
  std::sort(waiting_.begin(), waiting_.end(), [&](const map::ChunkId& a, const map::ChunkId& b) {
    return std::tuple(distance2_m2(a, robot_in_map_m), a) < std::tuple(distance2_m2(b, robot_in_map_m), b);
  });
  under_way_.clear();
  under_way_bytes_ = 0;
}

bool ChunkPlan::release(const map::ChunkId& chunk) {
  const bool waits = std::erase(waiting_, chunk) > 0;
  return withheld_.insert(chunk).second || waits;
}

bool ChunkPlan::fetch(const map::ChunkId& chunk) {
  const bool waits = std::find(waiting_.begin(), waiting_.end(), chunk) != waiting_.end();
  if (!withheld_.contains(chunk) || waits) return false;
  waiting_.push_front(chunk);
  return true;
}

map::ChunkId ChunkPlan::take() {
  EDGESPLAT_CHECK(!waiting_.empty(), "a chunk waits");
  const map::ChunkId chunk = waiting_.front();
  waiting_.pop_front();
  withheld_.erase(chunk);
  return chunk;
}

void ChunkPlan::sent(std::uint64_t seq, std::size_t bytes) {
  under_way_.push_back({seq, bytes});
  under_way_bytes_ += bytes;
}

void ChunkPlan::confirmed(std::uint64_t seq) {
  while (!under_way_.empty() && under_way_.front().seq <= seq) {
    under_way_bytes_ -= under_way_.front().bytes;
    under_way_.pop_front();
  }
}

}  // namespace edgesplat::stream
