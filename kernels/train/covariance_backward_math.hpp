// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/host_device.hpp"

#include <cmath>

namespace edgesplat::train {

/// dL by the unit quaternion (x, y, z, w) from dL by its rotation matrix (row-major, as in
/// splat::covariance3d).
template <typename T>
EDGESPLAT_HOST_DEVICE inline void rotation_backward(const T* unit, const T* g, T* by_unit) {
  const T x = unit[0], y = unit[1], z = unit[2], w = unit[3];
  by_unit[0] = 2 * (y * (g[1] + g[3]) + z * (g[2] + g[6]) + w * (g[7] - g[5])) - 4 * x * (g[4] + g[8]);
  by_unit[1] = 2 * (x * (g[1] + g[3]) + z * (g[5] + g[7]) + w * (g[2] - g[6])) - 4 * y * (g[0] + g[8]);
  by_unit[2] = 2 * (x * (g[2] + g[6]) + y * (g[5] + g[7]) + w * (g[3] - g[1])) - 4 * z * (g[0] + g[4]);
  by_unit[3] = 2 * (x * (g[7] - g[5]) + y * (g[2] - g[6]) + z * (g[3] - g[1]));
}

/// Reverse of splat::covariance3d, for scales in metres. `by_cov` is dL by the full symmetric matrix, upper
/// triangle xx xy xz yy yz zz, each off-diagonal element being half of what the pair of them does. Takes a
/// quaternion of any length > 0; the gradient is across it.
template <typename T>
EDGESPLAT_HOST_DEVICE inline void covariance3d_backward(const T* quat, const T* scale, const T* by_cov,
                                                        T* by_quat, T* by_log_scale) {
  const T norm = std::sqrt(quat[0] * quat[0] + quat[1] * quat[1] + quat[2] * quat[2] + quat[3] * quat[3]);
  const T unit[4] = {quat[0] / norm, quat[1] / norm, quat[2] / norm, quat[3] / norm};
  const T x = unit[0], y = unit[1], z = unit[2], w = unit[3];
  const T r[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                  2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                  2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
  const T g[9] = {by_cov[0], by_cov[1], by_cov[2], by_cov[1], by_cov[3],
                  by_cov[4], by_cov[2], by_cov[4], by_cov[5]};
  T by_r[9];
  EDGESPLAT_UNROLL
  for (int j = 0; j < 3; ++j) {
    T along = 0;
    EDGESPLAT_UNROLL
    for (int i = 0; i < 3; ++i) {
      // Covariance M M^T with M = R S: dL/dM = 2 G M.
      const T by_m = 2 * scale[j] * (g[3 * i] * r[j] + g[3 * i + 1] * r[3 + j] + g[3 * i + 2] * r[6 + j]);
      along += by_m * r[3 * i + j];
      by_r[3 * i + j] = by_m * scale[j];
    }
    by_log_scale[j] = along * scale[j];
  }
  T by_unit[4];
  rotation_backward(unit, by_r, by_unit);
  const T radial = by_unit[0] * x + by_unit[1] * y + by_unit[2] * z + by_unit[3] * w;
  EDGESPLAT_UNROLL
  for (int i = 0; i < 4; ++i) by_quat[i] = (by_unit[i] - unit[i] * radial) / norm;
}

}  // namespace edgesplat::train
