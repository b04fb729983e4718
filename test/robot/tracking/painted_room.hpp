// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/sensor/image.hpp"
#include "common/sensor/rig.hpp"
#include "robot/tracking/plane_map.hpp"
#include "test/support/random.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

namespace edgesplat::test {

/// A box of 10 x 8 x 3 m with a smooth painting on every side, as pictures, LiDAR points and a map of its
/// planes: the truth that a camera's pose can be tested against.
class PaintedRoom {
 public:
  /// Where a ray from inside meets a wall.
  static Eigen::Vector3d hit(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
    double nearest = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(direction(axis)) < 1e-12) continue;
      const double wall = direction(axis) > 0.0 ? kHalf_m(axis) : -kHalf_m(axis);
      nearest = std::min(nearest, (wall - from(axis)) / direction(axis));
    }
    return from + nearest * direction;
  }
  static double brightness(const Eigen::Vector3d& p) {
    const double waves = std::sin(5.1 * p.x() + 1.7 * p.y()) + std::sin(4.3 * p.y() - 2.2 * p.z()) +
                         std::sin(6.7 * p.z() + 3.1 * p.x()) +
                         std::sin(11.0 * p.x() - 7.0 * p.z() + 9.0 * p.y());
    return 110.0 + 22.0 * waves;
  }
  /// `gain` brightens as a longer exposure would: on the values plus 14.
  static std::shared_ptr<const sensor::ImageRgb8> picture(const geometry::CameraModel& camera,
                                                          const geometry::RigidTransform& room_from_camera,
                                                          double gain = 1.0) {
    auto image = std::make_shared<sensor::ImageRgb8>(camera.width_px, camera.height_px);
    for (int y = 0; y < camera.height_px; ++y) {
      for (int x = 0; x < camera.width_px; ++x) {
        const Eigen::Vector3d ray = room_from_camera.rotation * camera.unproject(Eigen::Vector2d(x, y));
        const double value = gain * (brightness(hit(room_from_camera.translation_m, ray)) + 14.0) - 14.0;
        std::fill_n(image->pixel(x, y), 3, static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0)));
      }
    }
    return image;
  }
  static void map(tracking::PlaneMap& planes) {
    Random random(1);
    const tracking::Symmetric3f noise = tracking::pack((1e-6F * Eigen::Matrix3f::Identity()).eval());
    for (int i = 0; i < 60000; ++i)
      planes.insert({hit(Eigen::Vector3d::Zero(), random.direction()), noise, tracking::Symmetric3f::Zero()},
                    Eigen::Vector3d::Zero());
  }
  /// What a LiDAR at a body measures, in the body.
  static std::vector<Eigen::Vector3f> scan(const geometry::RigidTransform& room_from_body, int points) {
    Random random(2);
    std::vector<Eigen::Vector3f> seen;
    for (int i = 0; i < points; ++i) {
      const Eigen::Vector3d p = hit(room_from_body.translation_m, random.direction());
      seen.push_back((room_from_body.inverse() * p).cast<float>());
    }
    return seen;
  }
  static sensor::CameraMount camera() {
    sensor::CameraMount mount;
    mount.model.width_px = 320;
    mount.model.height_px = 256;
    mount.model.fx_px = mount.model.fy_px = 160.0;
    mount.model.cx_px = 160.2;
    mount.model.cy_px = 127.1;
    mount.model.distortion = {-0.06, 0.01, 0.0004, -0.0003};
    Eigen::Matrix3d axes;
    axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    mount.body_from_camera = {Eigen::Quaterniond(axes), {0.09, 0.01, 0.13}};
    return mount;
  }

 private:
  static double kHalf_m(int axis) { return axis == 0 ? 5.0 : axis == 1 ? 4.0 : 1.5; }
};

}  // namespace edgesplat::test
