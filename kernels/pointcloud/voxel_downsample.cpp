// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/pointcloud/voxel_downsample.hpp"

#include "common/base/check.hpp"

#include <algorithm>
#include <bit>

namespace edgesplat::pointcloud {
namespace {

constexpr std::uint32_t kEmpty = ~std::uint32_t{0};

/// The lower wins a cell. An odd factor makes it a permutation: no two points draw the same.
std::uint32_t lot(std::size_t point) {
  std::uint32_t bits = static_cast<std::uint32_t>(point) * 0x9E3779B9U;
  bits ^= bits >> 15U;
  return bits * 0x85EBCA6BU;
}

}  // namespace

std::span<const std::uint32_t> VoxelDownsampler::run(std::span<const Eigen::Vector3f> points, float edge_m) {
  EDGESPLAT_CHECK(edge_m > 0.0F, "a voxel needs a size");
  kept_.clear();
  keys_.clear();
  if (points.empty()) return kept_;
  table_.assign(std::bit_ceil(points.size() + points.size() / 4), kEmpty);
  const std::size_t mask = table_.size() - 1;
  const float inverse_edge = 1.0F / edge_m;
  constexpr float kFarthestCell = 1e6F;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f cell = points[i] * inverse_edge;
    if (!(cell.cwiseAbs().maxCoeff() < kFarthestCell) || !cell.allFinite()) continue;
    const VoxelKey key = voxel_key(floor_to_cell(cell.x()), floor_to_cell(cell.y()), floor_to_cell(cell.z()));
    std::size_t slot = hash_key(key) & mask;
    while (table_[slot] != kEmpty && keys_[table_[slot]] != key) slot = (slot + 1) & mask;
    if (table_[slot] == kEmpty) {
      table_[slot] = static_cast<std::uint32_t>(kept_.size());
      keys_.push_back(key);
      kept_.push_back(static_cast<std::uint32_t>(i));
    } else if (std::uint32_t& kept = kept_[table_[slot]]; lot(i) < lot(kept)) {
      kept = static_cast<std::uint32_t>(i);
    }
  }
  return kept_;
}

}  // namespace edgesplat::pointcloud
