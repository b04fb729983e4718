// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/chunk_id.hpp"

#include <cmath>

namespace edgesplat::map {
namespace {

std::int32_t cell(float coordinate_m) {
  return static_cast<std::int32_t>(std::floor(coordinate_m / kChunkEdge_m));
}

bool within_slack(std::int32_t current, float coordinate_m) {
  const float low = static_cast<float>(current) * kChunkEdge_m;
  return coordinate_m >= low - kChunkSlack_m && coordinate_m < low + kChunkEdge_m + kChunkSlack_m;
}

}  // namespace

bool chunk_in_map(const ChunkId& chunk) {
  constexpr auto kMaxCell = static_cast<std::int32_t>(kMapLimit_m / kChunkEdge_m) + 1;
  const auto inside = [](std::int32_t cell) { return cell >= -kMaxCell && cell <= kMaxCell; };
  return inside(chunk.x) && inside(chunk.y) && inside(chunk.z);
}

ChunkId chunk_of(const Eigen::Vector3f& p_in_map_m) {
  return {cell(p_in_map_m.x()), cell(p_in_map_m.y()), cell(p_in_map_m.z())};
}

ChunkId chunk_after_move(const ChunkId& current, const Eigen::Vector3f& p_in_map_m) {
  const bool stays = within_slack(current.x, p_in_map_m.x()) && within_slack(current.y, p_in_map_m.y()) &&
                     within_slack(current.z, p_in_map_m.z());
  return stays ? current : chunk_of(p_in_map_m);
}

}  // namespace edgesplat::map
