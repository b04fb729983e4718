// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/pointcloud/voxel_key.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::pointcloud {

/// Thins a cloud: keeps one point of every occupied cell of a grid, drawn by lot (the same one for the same
/// cloud, always). The first would be a choice by time: of the rays of a turning LiDAR that end in a cell,
/// the first are those whose bearing noise points the way it turns, which turns far places of every scan by
/// some microradians; a map of such scans turned by 12 mrad in 300 m. Owns the tables it needs, so that a
/// caller who keeps it allocates nothing after the first clouds. Single-owner.
class VoxelDownsampler {
 public:
  /// Indices of the kept points, in the order in which their cells were first met; valid until the next call.
  /// Points that are not finite or farther than a million cells from the origin are left out. `edge_m` > 0.
  /// O(points).
  std::span<const std::uint32_t> run(std::span<const Eigen::Vector3f> points, float edge_m);

 private:
  std::vector<std::uint32_t> table_;  ///< open addressing: places in the two below
  std::vector<VoxelKey> keys_;
  std::vector<std::uint32_t> kept_;
};

}  // namespace edgesplat::pointcloud
