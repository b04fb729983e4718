// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace edgesplat::mapping {

/// Up to eight nearest points, nearest first.
struct Neighbours {
  static constexpr std::size_t kMost = 8;
  std::array<std::uint32_t, kMost> index{};
  std::array<float, kMost> squared_m2{};
  std::size_t count = 0;
};

/// Finds the nearest of some points within one cell's edge. Borrows the points; immutable after construction
/// and thread-safe. The result does not depend on anything but the points and their order.
class NeighbourGrid {
 public:
  NeighbourGrid(std::span<const Eigen::Vector3f> points_m, float edge_m);
  [[nodiscard]] Neighbours nearest(const Eigen::Vector3f& p_m) const;

 private:
  std::span<const Eigen::Vector3f> points_m_;
  float edge_m_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> by_cell_;  ///< sorted by cell, then by index
};

}  // namespace edgesplat::mapping
