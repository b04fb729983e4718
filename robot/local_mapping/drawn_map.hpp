// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "robot/map/resident_map.hpp"

#include <memory>
#include <mutex>

namespace edgesplat::local_mapping {

/// The same Gaussians in another frame; `a`'s where the transform is the identity. Colours that depend on the
/// direction keep theirs.
[[nodiscard]] std::shared_ptr<const gaussian::GaussianCloud> moved(
    std::shared_ptr<const gaussian::GaussianCloud> in_a, const geometry::RigidTransform& b_from_a);

/// What the renderer draws: what the server made and, until it is retired, what the robot made itself. Put
/// together once a change, on the thread that brings it. Thread-safe; snapshot() never waits for that.
class DrawnMap {
 public:
  DrawnMap();

  /// The resident map in `map`, and where the robot's frame lies in it.
  void set_resident(std::shared_ptr<const gaussian::GaussianCloud> in_map,
                    const map::MapFromOdom& map_from_odom);
  /// The robot's own Gaussians in `odom`.
  void set_provisional(std::shared_ptr<const gaussian::GaussianCloud> in_odom);

  /// In `map`; never null.
  [[nodiscard]] std::shared_ptr<const gaussian::GaussianCloud> snapshot() const;
  /// The same with the correction that it was put together with.
  struct Placed {
    std::shared_ptr<const gaussian::GaussianCloud> in_map;
    geometry::RigidTransform map_from_odom;
  };
  [[nodiscard]] Placed placed() const;

 private:
  void merge();

  std::mutex parts_mutex_;  ///< guards the parts, also while they are put together
  std::shared_ptr<const gaussian::GaussianCloud> resident_in_map_;
  map::MapFromOdom map_from_odom_;
  std::shared_ptr<const gaussian::GaussianCloud> provisional_in_odom_;
  std::shared_ptr<const gaussian::GaussianCloud> provisional_in_map_;  ///< moved by map_from_odom_

  mutable std::mutex drawn_mutex_;
  Placed drawn_;
};

}  // namespace edgesplat::local_mapping
