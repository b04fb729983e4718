// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/rigid_transform.hpp"
#include "common/map/keyframe.hpp"

#include <Eigen/Core>

#include <optional>
#include <span>

namespace edgesplat::mapping {

/// The floor that the robot stands on: normal . p = offset_m for p in the map frame, normal upwards.
struct GroundPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset_m = 0.0;
};

/// How far away the floor is along rays of one camera. Immutable.
class FloorDepth {
 public:
  FloorDepth(const GroundPlane& ground, const geometry::RigidTransform& map_from_camera)
      : normal_in_camera_((map_from_camera.rotation.conjugate() * ground.normal).cast<float>()),
        height_m_(static_cast<float>(ground.normal.dot(map_from_camera.translation_m) - ground.offset_m)) {}

  /// Of the camera over the floor.
  [[nodiscard]] float height_m() const { return height_m_; }
  /// 1 over the depth at which the ray (z = 1) meets the floor; 0 or less where it never does.
  [[nodiscard]] float inverse_depth(const Eigen::Vector3f& ray) const {
    return -normal_in_camera_.dot(ray) / height_m_;
  }

 private:
  Eigen::Vector3f normal_in_camera_;
  float height_m_;
};

struct GroundOptions {
  double below_body_m = 0.15;   ///< the floor lies at least so far under the body's origin, 0..2
  double most_below_m = 3.0;    ///< and at most so far, 0.2..10
  double band_m = 0.04;         ///< half thickness of what is taken as the floor, 0.01..0.3
  double max_slope_rad = 0.25;  ///< of a floor that one can stand on, 0.01..0.8
  int min_points = 40;          ///< 20..100000
};

/// The best supported level within a robot's height under it, fitted by least squares; nothing where no level
/// has enough points or the fit is too steep. The map's z is up (gravity-aligned).
[[nodiscard]] std::optional<GroundPlane> find_ground(std::span<const map::ColouredPoint> points_in_body,
                                                     const geometry::RigidTransform& map_from_body,
                                                     const GroundOptions& options);

}  // namespace edgesplat::mapping
