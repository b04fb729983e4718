// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/static_scene.hpp"

#include <utility>
#include <vector>

namespace edgesplat::simulate {

StaticScene::StaticScene(Scene scene) : scene_(std::move(scene)) {
  std::vector<Bounds> boxes;
  boxes.reserve(scene_.primitives.size());
  for (const Primitive& p : scene_.primitives) boxes.push_back(bounds(p));
  bvh_ = Bvh(boxes);
}

std::optional<StaticScene::Nearest> StaticScene::nearest(const Eigen::Vector3d& origin_m,
                                                         const Eigen::Vector3d& direction, double from_m,
                                                         double to_m) const {
  Nearest best;
  bool found = false;
  bvh_.walk(origin_m, direction, to_m, [&](std::uint32_t index, double limit_m) {
    const double t = intersect(scene_.primitives[index], origin_m, direction, from_m, limit_m);
    if (t < limit_m) {
      best = {index, t};
      found = true;
    }
    return t;
  });
  return found ? std::optional(best) : std::nullopt;
}

bool StaticScene::blocked(const Eigen::Vector3d& origin_m, const Eigen::Vector3d& direction, double from_m,
                          double to_m) const {
  bool found = false;
  bvh_.walk(origin_m, direction, to_m, [&](std::uint32_t index, double limit_m) {
    if (found) return 0.0;
    found = intersect(scene_.primitives[index], origin_m, direction, from_m, limit_m) < limit_m;
    return found ? 0.0 : limit_m;
  });
  return found;
}

}  // namespace edgesplat::simulate
