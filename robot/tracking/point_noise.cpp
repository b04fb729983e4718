// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/point_noise.hpp"

#include <algorithm>
#include <cstddef>

namespace edgesplat::tracking {

Symmetric3f pack(const Eigen::Matrix3f& symmetric) {
  Symmetric3f packed;
  packed << symmetric(0, 0), symmetric(0, 1), symmetric(0, 2), symmetric(1, 1), symmetric(1, 2),
      symmetric(2, 2);
  return packed;
}

Eigen::Matrix3f unpack(const Symmetric3f& packed) {
  Eigen::Matrix3f symmetric;
  symmetric << packed(0), packed(1), packed(2), packed(1), packed(3), packed(4), packed(2), packed(4),
      packed(5);
  return symmetric;
}

PointNoise largest_noise(const sensor::Rig& rig) {
  sensor::LidarModel largest = rig.lidar;
  for (std::size_t unit = 1; unit < rig.lidar_count(); ++unit) {
    const sensor::LidarModel model = rig.mount_of(unit).model;
    largest.range_sigma_m = std::max(largest.range_sigma_m, model.range_sigma_m);
    largest.bearing_sigma_rad = std::max(largest.bearing_sigma_rad, model.bearing_sigma_rad);
  }
  return PointNoise(largest);
}

Eigen::Matrix3f PointNoise::covariance(const Eigen::Vector3f& ray_m) const {
  const float range_squared = std::max(ray_m.squaredNorm(), 1e-12F);
  const float across = bearing_variance_ * range_squared;
  Eigen::Matrix3f sigma = ((range_variance_ - across) / range_squared) * (ray_m * ray_m.transpose());
  sigma.diagonal().array() += across;
  return sigma;
}

}  // namespace edgesplat::tracking
