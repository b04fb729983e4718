// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/visual_map.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace edgesplat::tracking {

std::uint32_t VisualMap::add(const VisualPoint& point) {
  const std::uint32_t index = points_.allocate();
  slots_ = std::max(slots_, index + 1);
  points_[index] = point;
  points_[index].live = true;
  points_[index].observation_count = 0;
  return index;
}

void VisualMap::observe(std::uint32_t index, const VisualObservation& observation) {
  VisualPoint& point = points_[index];
  if (point.observation_count == VisualPoint::kMaxObservations) {
    observations_.release(point.observations[1]);
    std::move(point.observations.begin() + 2, point.observations.end(), point.observations.begin() + 1);
    --point.observation_count;
  }
  const std::uint32_t added = observations_.allocate();
  observations_[added] = observation;
  point.observations[point.observation_count++] = added;
}

void VisualMap::erase(std::uint32_t index) {
  VisualPoint& point = points_[index];
  for (std::size_t i = 0; i < point.observation_count; ++i) observations_.release(point.observations[i]);
  point = VisualPoint{};
  points_.release(index);
}

void VisualMap::slide(const Eigen::Vector3d& centre, double half_extent_m) {
  const bool full = bytes() > max_bytes_;
  std::vector<std::pair<double, std::uint32_t>> by_distance;
  for (std::uint32_t index = 0; index < slots_; ++index) {
    if (!points_[index].live) continue;
    const double distance = (points_[index].p_in_odom_m - centre).cwiseAbs().maxCoeff();
    if (distance > half_extent_m) {
      erase(index);
    } else if (full) {
      by_distance.emplace_back(distance, index);
    }
  }
  std::sort(by_distance.begin(), by_distance.end(), std::greater<>());
  const std::size_t target = max_bytes_ / 10 * 9;
  for (const auto& [distance, index] : by_distance) {
    if (bytes() <= target) break;
    erase(index);
  }
}

}  // namespace edgesplat::tracking
