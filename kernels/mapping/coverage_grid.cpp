// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/coverage_grid.hpp"

namespace edgesplat::mapping {

int CoverageGrid::level_of(float range_m) const {
  const float wished_m = range_m * options_.cell_per_range;
  int level = 0;
  while (level + 1 < kLevels && cell_m(level + 1) <= wished_m) ++level;
  return level;
}

pointcloud::VoxelKey CoverageGrid::key(int level, const Eigen::Vector3f& p_in_map_m) const {
  const Eigen::Vector3f cell = p_in_map_m / cell_m(level);
  return pointcloud::voxel_key(pointcloud::floor_to_cell(cell.x()), pointcloud::floor_to_cell(cell.y()),
                               pointcloud::floor_to_cell(cell.z()));
}

bool CoverageGrid::covered(int level, pointcloud::VoxelKey key) const {
  return filled_[static_cast<std::size_t>(level)].find(key) != VoxelTable::kNone;
}

void CoverageGrid::fill(int level, const Eigen::Vector3f& p_in_map_m) {
  for (int at = level; at < kLevels; ++at) {
    (void)filled_[static_cast<std::size_t>(at)].find_or_add(key(at, p_in_map_m));
  }
}

std::size_t CoverageGrid::cells() const {
  std::size_t total = 0;
  for (const VoxelTable& table : filled_) total += table.size();
  return total;
}

}  // namespace edgesplat::mapping
