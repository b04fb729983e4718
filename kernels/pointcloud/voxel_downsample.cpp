// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/pointcloud/voxel_downsample.hpp"

#include "common/base/check.hpp"

#include <algorithm>
#include <bit>

namespace edgesplat::pointcloud {
namespace {

constexpr VoxelKey kEmpty = ~VoxelKey{0};  // 63 bits are used: no key has this value

}  // namespace

std::span<const std::uint32_t> VoxelDownsampler::run(std::span<const Eigen::Vector3f> points, float edge_m) {
  EDGESPLAT_CHECK(edge_m > 0.0F, "a voxel needs a size");
  kept_.clear();
  if (points.empty()) return kept_;
  table_.assign(std::bit_ceil(points.size() * 2), kEmpty);
  const std::size_t mask = table_.size() - 1;
  const float inverse_edge = 1.0F / edge_m;
  constexpr float kFarthestCell = 1e6F;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f cell = points[i] * inverse_edge;
    if (!(cell.cwiseAbs().maxCoeff() < kFarthestCell) || !cell.allFinite()) continue;
    const VoxelKey key = voxel_key(floor_to_cell(cell.x()), floor_to_cell(cell.y()), floor_to_cell(cell.z()));
    std::size_t slot = hash_key(key) & mask;
    while (table_[slot] != kEmpty && table_[slot] != key) slot = (slot + 1) & mask;
    if (table_[slot] == key) continue;
    table_[slot] = key;
    kept_.push_back(static_cast<std::uint32_t>(i));
  }
  return kept_;
}

}  // namespace edgesplat::pointcloud
