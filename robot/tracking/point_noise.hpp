// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/rig.hpp"

#include <Eigen/Core>

namespace edgesplat::tracking {

/// Upper triangle of a symmetric 3x3 matrix: xx xy xz yy yz zz.
using Symmetric3f = Eigen::Matrix<float, 6, 1>;

[[nodiscard]] Symmetric3f pack(const Eigen::Matrix3f& symmetric);
[[nodiscard]] Eigen::Matrix3f unpack(const Symmetric3f& packed);

/// Variance of a LiDAR point along a unit direction: range noise along the ray, bearing noise (which the
/// beam's footprint on a slanted surface acts like) across it. All in one frame.
class PointNoise {
 public:
  explicit PointNoise(const sensor::LidarModel& model)
      : range_variance_(static_cast<float>(model.range_sigma_m * model.range_sigma_m)),
        bearing_variance_(static_cast<float>(model.bearing_sigma_rad * model.bearing_sigma_rad)) {}

  /// direction' Sigma direction for a point at `ray_m` from the sensor.
  [[nodiscard]] float variance_along(const Eigen::Vector3f& ray_m, const Eigen::Vector3f& direction) const {
    const float range_squared = ray_m.squaredNorm();
    if (range_squared <= 0.0F) return range_variance_;
    const float along = ray_m.dot(direction);
    const float cosine_squared = along * along / range_squared;
    return range_variance_ * cosine_squared + bearing_variance_ * range_squared * (1.0F - cosine_squared);
  }
  /// The whole matrix: range_variance w w' + bearing_variance r^2 (I - w w'), w the ray's direction.
  [[nodiscard]] Eigen::Matrix3f covariance(const Eigen::Vector3f& ray_m) const;

 private:
  float range_variance_;
  float bearing_variance_;
};

/// Of the LiDARs of a rig, the largest of each kind.
[[nodiscard]] PointNoise largest_noise(const sensor::Rig& rig);

/// Where the rays of one LiDAR begin, and how noisy they are.
struct Beam {
  Eigen::Vector3f lidar_in_body_m;
  PointNoise noise;
};
[[nodiscard]] inline Beam beam_of(const sensor::LidarMount& mount) {
  return {mount.body_from_lidar.translation_m.cast<float>(), PointNoise(mount.model)};
}

}  // namespace edgesplat::tracking
