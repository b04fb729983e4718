// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/pointcloud/voxel_key.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::pointcloud {

/// Thins a cloud: keeps the first point of every occupied cell of a grid. Owns the table it needs, so that a
/// caller who keeps it allocates nothing after the first clouds. Single-owner.
class VoxelDownsampler {
 public:
  /// Indices of the kept points, ascending; valid until the next call. Points that are not finite or farther
  /// than a million cells from the origin are left out. `edge_m` > 0. O(points).
  std::span<const std::uint32_t> run(std::span<const Eigen::Vector3f> points, float edge_m);

 private:
  std::vector<VoxelKey> table_;
  std::vector<std::uint32_t> kept_;
};

}  // namespace edgesplat::pointcloud
