// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/mapping/voxel_table.hpp"

#include <Eigen/Core>

#include <array>

namespace edgesplat::mapping {

struct CoverageOptions {
  float near_cell_m = 0.06F;  ///< finest cell, 0.02..1
  float cell_per_range =
      0.006F;  ///< wished cell = range times this (one Mid-360 beam is 2.6 mrad wide), 0..0.1
};

/// Which places the map covers already, and how finely: cubic grids of doubling cell size. A surface seen
/// from afar fills coarse cells; seen again from near, it may be filled once more with finer ones, never
/// twice alike. Single-owner.
class CoverageGrid {
 public:
  static constexpr int kLevels = 5;

  explicit CoverageGrid(const CoverageOptions& options) : options_(options) {}

  /// The level for a point measured at `range_m`.
  [[nodiscard]] int level_of(float range_m) const;
  [[nodiscard]] float cell_m(int level) const {
    return options_.near_cell_m * static_cast<float>(1 << level);
  }
  [[nodiscard]] pointcloud::VoxelKey key(int level, const Eigen::Vector3f& p_in_map_m) const;
  /// Something of this level or a finer one is there.
  [[nodiscard]] bool covered(int level, pointcloud::VoxelKey key) const;
  /// Fills the point's cells of this level and of all coarser ones.
  void fill(int level, const Eigen::Vector3f& p_in_map_m);
  [[nodiscard]] std::size_t cells() const;

 private:
  CoverageOptions options_;
  std::array<VoxelTable, kLevels> filled_;
};

}  // namespace edgesplat::mapping
