// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/world.hpp"
#include "tools/simulate/world/bvh.hpp"
#include "tools/simulate/world/scene.hpp"

#include <optional>

namespace edgesplat::simulate {

/// The still part of a world under its BVH. Immutable, thread-safe.
class StaticScene {
 public:
  explicit StaticScene(Scene scene);

  struct Nearest {
    std::uint32_t primitive = 0;
    double range_m = 0.0;
  };
  [[nodiscard]] std::optional<Nearest> nearest(const Eigen::Vector3d& origin_m,
                                               const Eigen::Vector3d& direction, double from_m,
                                               double to_m) const;
  /// True when anything lies between `from_m` and `to_m`.
  [[nodiscard]] bool blocked(const Eigen::Vector3d& origin_m, const Eigen::Vector3d& direction, double from_m,
                             double to_m) const;
  [[nodiscard]] const Scene& scene() const { return scene_; }

 private:
  Scene scene_;
  Bvh bvh_;
};

}  // namespace edgesplat::simulate
