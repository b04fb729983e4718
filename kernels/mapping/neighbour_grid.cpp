// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/neighbour_grid.hpp"

#include "kernels/pointcloud/voxel_key.hpp"

#include <algorithm>

namespace edgesplat::mapping {
namespace {

void offer(Neighbours& best, std::uint32_t index, float squared_m2) {
  std::size_t at = best.count;
  while (at > 0 && squared_m2 < best.squared_m2[at - 1]) --at;
  if (at == Neighbours::kMost) return;
  best.count = std::min(best.count + 1, Neighbours::kMost);
  for (std::size_t i = best.count - 1; i > at; --i) {
    best.index[i] = best.index[i - 1];
    best.squared_m2[i] = best.squared_m2[i - 1];
  }
  best.index[at] = index;
  best.squared_m2[at] = squared_m2;
}

/// Like voxel_key, but cells in a row along z have keys in a row, also across zero.
std::uint64_t ordered_key(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::int64_t kMiddle = 1 << 20;
  return pointcloud::voxel_key(x + kMiddle, y + kMiddle, z + kMiddle);
}

}  // namespace

NeighbourGrid::NeighbourGrid(std::span<const Eigen::Vector3f> points_m, float edge_m)
    : points_m_(points_m), edge_m_(edge_m) {
  by_cell_.reserve(points_m.size());
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Vector3f cell = points_m[i] / edge_m;
    by_cell_.emplace_back(
        ordered_key(pointcloud::floor_to_cell(cell.x()), pointcloud::floor_to_cell(cell.y()),
                    pointcloud::floor_to_cell(cell.z())),
        static_cast<std::uint32_t>(i));
  }
  std::sort(by_cell_.begin(), by_cell_.end());
}

Neighbours NeighbourGrid::nearest(const Eigen::Vector3f& p_m) const {
  Neighbours best;
  const Eigen::Vector3f cell = p_m / edge_m_;
  const std::int64_t x = pointcloud::floor_to_cell(cell.x());
  const std::int64_t y = pointcloud::floor_to_cell(cell.y());
  const std::int64_t z = pointcloud::floor_to_cell(cell.z());
  for (std::int64_t dx = -1; dx <= 1; ++dx) {
    for (std::int64_t dy = -1; dy <= 1; ++dy) {
      const std::uint64_t last = ordered_key(x + dx, y + dy, z + 1);
      auto entry = std::lower_bound(by_cell_.begin(), by_cell_.end(),
                                    std::pair{ordered_key(x + dx, y + dy, z - 1), std::uint32_t{0}});
      for (; entry != by_cell_.end() && entry->first <= last; ++entry) {
        const float squared_m2 = (points_m_[entry->second] - p_m).squaredNorm();
        if (squared_m2 <= edge_m_ * edge_m_) offer(best, entry->second, squared_m2);
      }
    }
  }
  return best;
}

}  // namespace edgesplat::mapping
