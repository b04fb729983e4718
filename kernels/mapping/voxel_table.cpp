// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/voxel_table.hpp"

#include <utility>

namespace edgesplat::mapping {

std::size_t VoxelTable::slot_of(pointcloud::VoxelKey key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = pointcloud::hash_key(key) & mask;
  while (slots_[at].number != kNone && slots_[at].key != key) at = (at + 1) & mask;
  return at;
}

std::uint32_t VoxelTable::find(pointcloud::VoxelKey key) const {
  return slots_.empty() ? kNone : slots_[slot_of(key)].number;
}

std::uint32_t VoxelTable::find_or_add(pointcloud::VoxelKey key) {
  if (2 * (size_ + 1) > slots_.size()) grow();
  Slot& slot = slots_[slot_of(key)];
  if (slot.number == kNone) slot = {key, static_cast<std::uint32_t>(size_++)};
  return slot.number;
}

void VoxelTable::grow() {
  const std::vector<Slot> old =
      std::exchange(slots_, std::vector<Slot>(slots_.empty() ? 1024 : 2 * slots_.size()));
  for (const Slot& slot : old) {
    if (slot.number != kNone) slots_[slot_of(slot.key)] = slot;
  }
}

}  // namespace edgesplat::mapping
