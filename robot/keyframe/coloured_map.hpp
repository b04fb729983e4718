// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/keyframe.hpp"
#include "robot/keyframe/colouriser.hpp"

#include <cstdint>
#include <unordered_set>
#include <vector>

namespace edgesplat::keyframe {

/// The coloured points of all keyframes on a grid, for pictures and export: first come, first kept; a bound
/// on the number of points, above which new ones are counted and dropped. Single-owner.
class ColouredMap {
 public:
  ColouredMap(double spacing_m, std::size_t max_points)
      : spacing_m_(static_cast<float>(spacing_m)), max_points_(max_points) {}

  void add(const map::Keyframe& keyframe);
  [[nodiscard]] const std::vector<OdomPoint>& points() const { return points_; }
  [[nodiscard]] std::int64_t dropped() const { return dropped_; }

 private:
  float spacing_m_;
  std::size_t max_points_;
  std::unordered_set<std::uint64_t> occupied_;
  std::vector<OdomPoint> points_;
  std::int64_t dropped_ = 0;
};

}  // namespace edgesplat::keyframe
