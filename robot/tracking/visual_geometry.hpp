// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "robot/tracking/visual_map.hpp"

#include <Eigen/Core>

#include <optional>

namespace edgesplat::tracking {

/// A camera at a place.
struct CameraView {
  const geometry::CameraModel& camera;
  geometry::RigidTransform camera_from_odom;
  Eigen::Vector3d camera_in_odom_m;

  CameraView(const geometry::CameraModel& model, const geometry::RigidTransform& odom_from_camera)
      : camera(model),
        camera_from_odom(odom_from_camera.inverse()),
        camera_in_odom_m(odom_from_camera.translation_m) {}
};

/// A point as a camera sees it.
struct PointInView {
  Eigen::Vector2d pixel;
  Eigen::Vector3d p_in_camera_m;
  Eigen::Vector3d forward;                    ///< the camera's axis, in odom
  Eigen::Matrix<double, 2, 3> pixel_by_odom;  ///< d pixel / d point in odom
};
/// Nothing for a point behind the camera.
[[nodiscard]] std::optional<PointInView> look_at(const CameraView& view, const Eigen::Vector3d& p_in_odom_m);

/// The observation of a point that a view is compared with, and how it is warped.
struct Reference {
  std::uint32_t observation;
  Eigen::Matrix2d warp;    ///< pixels of the view for one pixel of the observation, at full size
  Eigen::Vector2d growth;  ///< of the depth in the view, less that in the observation (see image::PatchWarp)
};
/// The oldest observation from about the same side and distance, since it drifted least; else the one that is
/// warped least. Nothing where all are warped too much to be compared.
[[nodiscard]] std::optional<Reference> choose_reference(const VisualMap& map, const VisualPoint& point,
                                                        const PointInView& seen,
                                                        const Eigen::Vector3d& camera_in_odom_m);
/// True where a view is far enough from every observation of a point to be worth one.
[[nodiscard]] bool is_new_view(const VisualMap& map, const VisualPoint& point, const PointInView& seen,
                               const Eigen::Vector3d& camera_in_odom_m);

}  // namespace edgesplat::tracking
