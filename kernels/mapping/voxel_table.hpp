// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/pointcloud/voxel_key.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgesplat::mapping {

/// Numbers the cells of a grid in the order in which they are first seen: an open-addressing table of at most
/// half full, 16 bytes a slot. Single-owner.
class VoxelTable {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  /// The cell's number, or kNone.
  [[nodiscard]] std::uint32_t find(pointcloud::VoxelKey key) const;
  /// The cell's number; a new cell gets size().
  std::uint32_t find_or_add(pointcloud::VoxelKey key);
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  struct Slot {
    pointcloud::VoxelKey key = 0;
    std::uint32_t number = kNone;
  };
  [[nodiscard]] std::size_t slot_of(pointcloud::VoxelKey key) const;
  void grow();

  std::vector<Slot> slots_;  ///< a power of two
  std::size_t size_ = 0;
};

}  // namespace edgesplat::mapping
