// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The hash of root cells and the sliding box; the cells themselves are in plane_map.cpp.
#include "robot/tracking/plane_map.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::tracking {
namespace {

using Index3 = Eigen::Matrix<std::int64_t, 3, 1>;

std::size_t slot_of(const Index3& index, std::size_t mask) {
  return pointcloud::hash_key(pointcloud::voxel_key(index.x(), index.y(), index.z())) & mask;
}

}  // namespace

std::uint32_t PlaneMap::find_root(const Index3& index) const {
  const std::size_t mask = table_.size() - 1;
  for (std::size_t slot = slot_of(index, mask); table_[slot] != kNone; slot = (slot + 1) & mask) {
    if (roots_[table_[slot]].index == index) return table_[slot];
  }
  return kNone;
}

std::uint32_t PlaneMap::find_or_create_root(const Index3& index) {
  const std::uint32_t found = find_root(index);
  if (found != kNone) return found;
  if ((roots_.live() + 1) * 2 > table_.size()) grow_table();
  const std::uint32_t root = roots_.allocate();
  root_slots_ = std::max<std::size_t>(root_slots_, root + std::size_t{1});
  roots_[root].index = index;
  roots_[root].live = true;
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = slot_of(index, mask);
  while (table_[slot] != kNone) slot = (slot + 1) & mask;
  table_[slot] = root;
  return root;
}

void PlaneMap::grow_table() {
  table_.assign(table_.size() * 2, kNone);
  const std::size_t mask = table_.size() - 1;
  for (std::uint32_t root = 0; root < root_slots_; ++root) {
    if (!roots_[root].live) continue;
    std::size_t slot = slot_of(roots_[root].index, mask);
    while (table_[slot] != kNone) slot = (slot + 1) & mask;
    table_[slot] = root;
  }
}

void PlaneMap::erase_root(std::uint32_t root) {
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = slot_of(roots_[root].index, mask);
  while (table_[slot] != root) slot = (slot + 1) & mask;
  // Backward shift: close the gap so that probing needs no tombstones.
  for (std::size_t next = (slot + 1) & mask; table_[next] != kNone; next = (next + 1) & mask) {
    const std::size_t home = slot_of(roots_[table_[next]].index, mask);
    if (((next - home) & mask) >= ((next - slot) & mask)) {
      table_[slot] = table_[next];
      slot = next;
    }
  }
  table_[slot] = kNone;
  release_cell(roots_[root].cell);
  roots_[root].live = false;
  roots_.release(root);
  ++evicted_roots_;
}

void PlaneMap::slide(const Eigen::Vector3d& centre) {
  const bool moved = (centre - last_slide_m_).cwiseAbs().maxCoeff() > 0.1 * config_.half_extent_m;
  if (!moved && bytes() <= config_.max_bytes) return;
  last_slide_m_ = centre;
  std::vector<std::pair<double, std::uint32_t>> by_distance;
  for (std::uint32_t root = 0; root < root_slots_; ++root) {
    if (!roots_[root].live) continue;
    const Eigen::Vector3d middle = (roots_[root].index.cast<double>().array() + 0.5) * config_.root_voxel_m;
    const double distance = (middle - centre).cwiseAbs().maxCoeff();
    if (distance > config_.half_extent_m) {
      erase_root(root);
    } else {
      by_distance.emplace_back(distance, root);
    }
  }
  if (bytes() <= config_.max_bytes) return;
  std::sort(by_distance.begin(), by_distance.end(), std::greater<>());
  const std::size_t target = config_.max_bytes / 10 * 9;
  for (const auto& [distance, root] : by_distance) {
    if (bytes() <= target) break;
    erase_root(root);
  }
}

}  // namespace edgesplat::tracking
