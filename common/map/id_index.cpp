// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/id_index.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::map {

std::size_t IdIndex::home(std::uint64_t id) const {
  // Fibonacci hashing (Knuth, vol. 3, 6.4); the upper bits are the well mixed ones.
  return static_cast<std::size_t>((id * 0x9E3779B97F4A7C15ULL) >> 20U) & (slots_.size() - 1);
}

std::size_t IdIndex::slot_of(std::uint64_t id) const {
  std::size_t at = home(id);
  while (slots_[at].row != kFree && slots_[at].id != id) at = (at + 1) & (slots_.size() - 1);
  return at;
}

std::optional<std::uint32_t> IdIndex::find(gaussian::GaussianId id) const {
  if (slots_.empty()) return std::nullopt;
  const Slot& slot = slots_[slot_of(id.packed())];
  if (slot.row == kFree) return std::nullopt;
  return slot.row;
}

void IdIndex::set(gaussian::GaussianId id, std::uint32_t row) {
  if (4 * (size_ + 1) > 3 * slots_.size()) grow();
  Slot& slot = slots_[slot_of(id.packed())];
  if (slot.row == kFree) ++size_;
  slot = {id.packed(), row};
}

void IdIndex::erase(gaussian::GaussianId id) {
  if (slots_.empty()) return;
  std::size_t hole = slot_of(id.packed());
  if (slots_[hole].row == kFree) return;
  --size_;
  // What was pushed past the hole moves back into it, so that searches need no gravestones.
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t at = (hole + 1) & mask; slots_[at].row != kFree; at = (at + 1) & mask) {
    if (((at - home(slots_[at].id)) & mask) < ((at - hole) & mask)) continue;
    slots_[hole] = slots_[at];
    hole = at;
  }
  slots_[hole].row = kFree;
}

void IdIndex::clear() {
  slots_.clear();
  size_ = 0;
}

void IdIndex::grow() {
  const std::vector<Slot> old =
      std::exchange(slots_, std::vector<Slot>(std::max<std::size_t>(16, 2 * slots_.size())));
  for (const Slot& slot : old) {
    if (slot.row != kFree) slots_[slot_of(slot.id)] = slot;
  }
}

}  // namespace edgesplat::map
