// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/host_device.hpp"

#include <cmath>

namespace edgesplat::splat {

/// Maths of one Gaussian's projection, shared by every backend and, with T = double, by gradient checks.
/// Plain arrays and scalars, so that device compilers take it.

template <typename T>
struct CameraT {
  T fx, fy, cx, cy;
  T tan_x, tan_y;  ///< half-width and half-height of the picture over focal length, for the clamp below
  T rotation[9];   ///< camera_from_map, row-major
  T translation[3];
  T antialias =
      0;  ///< 1: splats smaller than a pixel are made fainter instead of brighter; a factor, not a branch
  T least_axis_px = 0;   ///< smaller Gaussians are thinned out (thin_math.hpp); 0: none
  bool fisheye = false;  ///< equidistant: the distance from (cx, cy) goes with the angle from the axis
};

template <typename T>
struct Projection {
  T p[3];      ///< mean in the camera frame, m
  T depth;     ///< along z, for a fisheye from the camera's centre, m
  T u, v;      ///< mean, px
  T cov[3];    ///< xx, xy, yy with the low-pass, px^2
  T conic[3];  ///< inverse of cov: xx, xy, yy
  T shrink;    ///< what the opacity is multiplied by: 1 unless anti-aliased
};

/// Covariance R S S^T R^T of a Gaussian, upper triangle xx xy xz yy yz zz (3DGS, eq. 6). The quaternion (x,
/// y, z, w) is normalised here.
template <typename T>
EDGESPLAT_HOST_DEVICE inline void covariance3d_of_scale(const T* quat, const T* scale, T* cov) {
  const T norm = std::sqrt(quat[0] * quat[0] + quat[1] * quat[1] + quat[2] * quat[2] + quat[3] * quat[3]);
  const T x = quat[0] / norm, y = quat[1] / norm, z = quat[2] / norm, w = quat[3] / norm;
  const T r[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                  2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                  2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
  T m[9];
  EDGESPLAT_UNROLL
  for (int j = 0; j < 3; ++j) {
    EDGESPLAT_UNROLL
    for (int i = 0; i < 3; ++i) m[3 * i + j] = r[3 * i + j] * scale[j];
  }
  int k = 0;
  EDGESPLAT_UNROLL
  for (int i = 0; i < 3; ++i) {
    EDGESPLAT_UNROLL
    for (int j = i; j < 3; ++j) {
      cov[k++] = m[3 * i] * m[3 * j] + m[3 * i + 1] * m[3 * j + 1] + m[3 * i + 2] * m[3 * j + 2];
    }
  }
}

template <typename T>
EDGESPLAT_HOST_DEVICE inline void covariance3d(const T* quat, const T* log_scale, T* cov) {
  const T scale[3] = {std::exp(log_scale[0]), std::exp(log_scale[1]), std::exp(log_scale[2])};
  covariance3d_of_scale(quat, scale, cov);
}

template <typename T>
EDGESPLAT_HOST_DEVICE inline void to_camera(const CameraT<T>& c, const T* mean, T* p) {
  const T* r = c.rotation;
  EDGESPLAT_UNROLL
  for (int i = 0; i < 3; ++i) {
    p[i] = r[3 * i] * mean[0] + r[3 * i + 1] * mean[1] + r[3 * i + 2] * mean[2] + c.translation[i];
  }
}

/// 2-D covariance, its inverse and the anti-aliasing factor sqrt(det without / det with the low-pass) (Yu
/// 2024, Mip-Splatting, eq. 9) from the rows a, b of J W, J = d(u, v)/d(p). False where the covariance is
/// singular. No branches, so that loops over Gaussians vectorise.
template <typename T>
EDGESPLAT_HOST_DEVICE inline bool spread(const CameraT<T>& c, const T* a, const T* b, const T* cov3d,
                                         T low_pass, Projection<T>& out) {
  const T* s = cov3d;
  const T sa[3] = {s[0] * a[0] + s[1] * a[1] + s[2] * a[2], s[1] * a[0] + s[3] * a[1] + s[4] * a[2],
                   s[2] * a[0] + s[4] * a[1] + s[5] * a[2]};
  const T sb[3] = {s[0] * b[0] + s[1] * b[1] + s[2] * b[2], s[1] * b[0] + s[3] * b[1] + s[4] * b[2],
                   s[2] * b[0] + s[4] * b[1] + s[5] * b[2]};
  const T own_xx = a[0] * sa[0] + a[1] * sa[1] + a[2] * sa[2];
  const T own_yy = b[0] * sb[0] + b[1] * sb[1] + b[2] * sb[2];
  out.cov[0] = own_xx + low_pass;
  out.cov[1] = a[0] * sb[0] + a[1] * sb[1] + a[2] * sb[2];
  out.cov[2] = own_yy + low_pass;
  const T det = out.cov[0] * out.cov[2] - out.cov[1] * out.cov[1];
  const bool regular = det > T(0);
  const T inverse = 1 / (regular ? det : T(1));
  out.conic[0] = out.cov[2] * inverse;
  out.conic[1] = -out.cov[1] * inverse;
  out.conic[2] = out.cov[0] * inverse;
  const T own_det = own_xx * own_yy - out.cov[1] * out.cov[1];
  const T share = (own_det > T(0) ? own_det : T(0)) * inverse;
  out.shrink = std::sqrt(1 + c.antialias * (share - 1));
  return regular;
}

/// EWA projection (Zwicker 2001, eq. 31) by a pinhole: mean and 2-D covariance J W Sigma W^T J^T + low_pass
/// I. The direction at which the Jacobian is taken is clamped to 1.3 times the picture's half-angle (as in
/// 3DGS), since far outside the linearisation explodes. False where the mean is nearer than near_m or the 2-D
/// covariance is singular.
template <typename T>
EDGESPLAT_HOST_DEVICE inline bool project(const CameraT<T>& c, const T* mean, const T* cov3d, T near_m,
                                          T low_pass, Projection<T>& out) {
  const T* r = c.rotation;
  to_camera(c, mean, out.p);
  // No branches: what is too near is projected as if it were not.
  const bool in_front = out.p[2] > near_m;
  const T z = in_front ? out.p[2] : T(1);
  out.depth = out.p[2];
  const T x_limit = T(1.3) * c.tan_x, y_limit = T(1.3) * c.tan_y;
  T x = out.p[0] / z, y = out.p[1] / z;
  out.u = c.fx * x + c.cx;
  out.v = c.fy * y + c.cy;
  x = x < -x_limit ? -x_limit : (x > x_limit ? x_limit : x);
  y = y < -y_limit ? -y_limit : (y > y_limit ? y_limit : y);
  T a[3], b[3];
  EDGESPLAT_UNROLL
  for (int i = 0; i < 3; ++i) {
    a[i] = c.fx / z * (r[i] - x * r[6 + i]);
    b[i] = c.fy / z * (r[3 + i] - y * r[6 + i]);
  }
  const bool regular = spread(c, a, b, cov3d, low_pass, out);
  return in_front && regular;
}

}  // namespace edgesplat::splat
