// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"

#include <cmath>
#include <random>

namespace edgesplat::io {

/// `count` Gaussians with normally distributed values and unit rotations.
inline gaussian::GaussianCloud make_cloud(std::size_t count, int degree) {
  std::mt19937 random(4);
  std::normal_distribution<float> normal;
  gaussian::GaussianCloud cloud;
  cloud.sh_degree = degree;
  cloud.resize(count);
  for (auto* values :
       {&cloud.means_m, &cloud.log_scales, &cloud.quats_xyzw, &cloud.opacity_logits, &cloud.sh}) {
    for (float& value : *values) value = normal(random);
  }
  for (std::size_t i = 0; i < count; ++i) {
    float* q = &cloud.quats_xyzw[i * 4];
    const float norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int k = 0; k < 4; ++k) q[k] /= norm;
    cloud.ids[i] = gaussian::GaussianId(3, i + 100);
  }
  return cloud;
}

/// Angle between the rotations of one row of two clouds.
inline float angle_between_rad(const gaussian::GaussianCloud& a, const gaussian::GaussianCloud& b,
                               std::size_t row) {
  float dot = 0.0F;
  for (std::size_t i = 4 * row; i < 4 * row + 4; ++i) dot += a.quats_xyzw[i] * b.quats_xyzw[i];
  return 2.0F * std::acos(std::min(1.0F, std::abs(dot)));
}

}  // namespace edgesplat::io
