// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/rig.hpp"
#include "robot/tracking/tracked_group.hpp"

namespace edgesplat::keyframe {

/// A rig whose camera looks along the body's x axis, 100x80 pixels, 100 px focal length.
inline sensor::Rig forward_rig() {
  sensor::Rig rig;
  sensor::CameraMount mount;
  mount.model = {geometry::CameraKind::kPinhole, 100, 80, 100.0, 100.0, 49.5, 39.5, {}};
  Eigen::Matrix3d body_from_camera;
  body_from_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;  // camera x right = body -y, y down = -z, z forward = x
  mount.body_from_camera.rotation = Eigen::Quaterniond(body_from_camera);
  rig.camera = mount;
  return rig;
}

inline tracking::TrackedGroup tracked_at(double time_s, const Eigen::Vector3d& position_m) {
  tracking::TrackedGroup group;
  group.stamp = HostTime(from_seconds(time_s));
  group.odom_from_body.translation_m = position_m;
  group.health.state = tracking::TrackingState::kTracking;
  return group;
}

/// A square of points at body x = distance, y and z in [-half, half].
inline void add_wall(tracking::TrackedGroup& group, float distance_m, float half_m, float step_m) {
  for (float y = -half_m; y <= half_m; y += step_m) {
    for (float z = -half_m; z <= half_m; z += step_m) {
      group.points_in_body.push_back({Eigen::Vector3f(distance_m, y, z), 0.5F});
    }
  }
}

/// A picture whose left half is red and whose right half is blue.
inline sensor::ImageRgb8 red_blue_image() {
  sensor::ImageRgb8 image(100, 80);
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 100; ++x) image.pixel(x, y)[x < 50 ? 0 : 2] = 200;
  }
  return image;
}

}  // namespace edgesplat::keyframe
