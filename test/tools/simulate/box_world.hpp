// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/world.hpp"

#include <limits>

namespace edgesplat::simulate {

/// The inside of an axis-aligned box, whose exact ranges are known: x in +-10 m, y in +-8 m, z in 0..4 m.
class BoxWorld final : public World {
 public:
  explicit BoxWorld(float reflectivity = 0.5F) : reflectivity_(reflectivity) {}

  std::optional<Hit> cast(const Ray& ray, Visibility /*visibility*/) const override {
    const Eigen::Vector3d low(-10.0, -8.0, 0.0), high(10.0, 8.0, 4.0);
    Hit hit;
    hit.range_m = std::numeric_limits<double>::max();
    for (int axis = 0; axis < 3; ++axis) {
      const double d = ray.direction[axis];
      if (d == 0.0) continue;
      const double range_m = ((d > 0 ? high[axis] : low[axis]) - ray.origin_m[axis]) / d;
      if (range_m >= hit.range_m) continue;
      hit.range_m = range_m;
      hit.normal = Eigen::Vector3d::Zero();
      hit.normal[axis] = d > 0 ? -1.0 : 1.0;
    }
    hit.reflectivity = reflectivity_;
    hit.uv_m = Eigen::Vector2d::Zero();
    return hit;
  }
  Eigen::Vector3f radiance(const Ray& /*ray*/, const std::optional<Hit>& /*hit*/, double /*footprint_m*/,
                           Visibility /*visibility*/) const override {
    return Eigen::Vector3f::Constant(0.4F);
  }
  Path path() const override { return {{{-6, -4, 0.6}, {6, -4, 0.6}, {6, 4, 0.6}, {-6, 4, 0.6}}, true, 1.2}; }

 private:
  float reflectivity_;
};

}  // namespace edgesplat::simulate
