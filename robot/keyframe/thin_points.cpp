// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/thin_points.hpp"

#include "robot/keyframe/cell_key.hpp"

#include <unordered_set>

namespace edgesplat::keyframe {

std::vector<map::ColouredPoint> thin_points(std::vector<map::ColouredPoint> points, float spacing_m) {
  if (spacing_m <= 0.0F) return points;
  std::unordered_set<std::uint64_t> seen;
  seen.reserve(points.size());
  std::erase_if(points, [&](const map::ColouredPoint& p) {
    const auto key = cell_key(p.p_in_body_m, spacing_m);
    return !key || !seen.insert(*key).second;
  });
  return points;
}

}  // namespace edgesplat::keyframe
