// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/sh_math.hpp"

#include <cmath>

namespace edgesplat::train {

/// Adds the gradient of sum_k weight[k] basis[k] by the direction, taking x, y and z as free.
template <typename T>
EDGESPLAT_HOST_DEVICE inline void sh_direction_backward(int degree, T x, T y, T z, const T* weight, T* by) {
  by[0] = by[1] = by[2] = 0;
  if (degree < 1) return;
  const T* w = weight;
  by[0] += T(-0.4886025119029199) * w[3];
  by[1] += T(-0.4886025119029199) * w[1];
  by[2] += T(0.4886025119029199) * w[2];
  if (degree < 2) return;
  const T k4 = T(1.0925484305920792), k6 = T(0.31539156525252005), k8 = T(0.5462742152960396);
  by[0] += k4 * (y * w[4] - z * w[7]) - 2 * k6 * x * w[6] + 2 * k8 * x * w[8];
  by[1] += k4 * (x * w[4] - z * w[5]) - 2 * k6 * y * w[6] - 2 * k8 * y * w[8];
  by[2] += k4 * (-y * w[5] - x * w[7]) + 4 * k6 * z * w[6];
  if (degree < 3) return;
  const T xx = x * x, yy = y * y, zz = z * z;
  const T k9 = T(-0.5900435899266435), k10 = T(2.890611442640554), k11 = T(-0.4570457994644658);
  const T k12 = T(0.3731763325901154), k14 = T(1.445305721320277);
  by[0] += k9 * 6 * x * y * w[9] + k10 * y * z * w[10] - k11 * 2 * x * y * w[11] - k12 * 6 * x * z * w[12] +
           k11 * (4 * zz - 3 * xx - yy) * w[13] + k14 * 2 * x * z * w[14] + k9 * 3 * (xx - yy) * w[15];
  by[1] += k9 * 3 * (xx - yy) * w[9] + k10 * x * z * w[10] + k11 * (4 * zz - xx - 3 * yy) * w[11] -
           k12 * 6 * y * z * w[12] - k11 * 2 * x * y * w[13] - k14 * 2 * y * z * w[14] -
           k9 * 6 * x * y * w[15];
  by[2] += k10 * x * y * w[10] + k11 * 8 * y * z * w[11] + k12 * 3 * (2 * zz - xx - yy) * w[12] +
           k11 * 8 * x * z * w[13] + k14 * (xx - yy) * w[14];
}

/// Reverse of splat::colour_towards: by_sh takes 3 (degree + 1)^2 values, by_offset dL by (mean - camera
/// position). A channel that the forward pass cut at 0 has no gradient. `rgb` is the colour as drawn.
template <typename T>
EDGESPLAT_HOST_DEVICE inline void colour_backward(int degree, const T* offset, const T* sh, const T* rgb,
                                                  const T* by_rgb, T* by_sh, T* by_offset) {
  const T length = std::sqrt(offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2]);
  const T d[3] = {offset[0] / length, offset[1] / length, offset[2] / length};
  T basis[16];
  splat::sh_basis(degree, d[0], d[1], d[2], basis);
  const T g[3] = {rgb[0] > 0 ? by_rgb[0] : T(0), rgb[1] > 0 ? by_rgb[1] : T(0),
                  rgb[2] > 0 ? by_rgb[2] : T(0)};
  const int terms = (degree + 1) * (degree + 1);
  T weight[16];
  for (int k = 0; k < terms; ++k) {
    weight[k] = 0;
    for (int c = 0; c < 3; ++c) {
      by_sh[3 * k + c] = basis[k] * g[c];
      weight[k] += sh[3 * k + c] * g[c];
    }
  }
  T by_d[3];
  sh_direction_backward(degree, d[0], d[1], d[2], weight, by_d);
  const T radial = by_d[0] * d[0] + by_d[1] * d[1] + by_d[2] * d[2];
  for (int i = 0; i < 3; ++i) by_offset[i] = (by_d[i] - d[i] * radial) / length;
}

}  // namespace edgesplat::train
