// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/fisheye_math.hpp"
#include "kernels/train/splat_gradient.hpp"

namespace edgesplat::train {

/// Reverse of splat::project for one Gaussian, shared by every backend and, with T = double, by gradient
/// checks.

template <typename T>
struct ProjectBackward {
  T mean[3];
  T cov3d[6];  ///< full symmetric matrix, as covariance3d_backward takes it
  T pose[6];   ///< dr, dt with camera_from_map ⊞ (dr, dt) = (rotation Exp(dr), translation + dt)
};

/// dL by the 2-D covariance (xx, xy counted once, yy) from dL by its inverse.
template <typename T>
EDGESPLAT_HOST_DEVICE inline void inverse2d_backward(const T* conic, const T* by_conic, T* by_cov) {
  const T a = conic[0], b = conic[1], c = conic[2];
  const T ga = by_conic[0], gb = by_conic[1], gc = by_conic[2];
  by_cov[0] = -(a * a * ga + a * b * gb + b * b * gc);
  by_cov[1] = -(2 * a * b * ga + (a * c + b * b) * gb + 2 * b * c * gc);
  by_cov[2] = -(b * b * ga + b * c * gb + c * c * gc);
}

template <typename T>
EDGESPLAT_HOST_DEVICE inline void cross(const T* a, const T* b, T* out) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

/// symmetric (upper triangle) times vector
template <typename T>
EDGESPLAT_HOST_DEVICE inline void symmetric_times(const T* s, const T* v, T* out) {
  out[0] = s[0] * v[0] + s[1] * v[1] + s[2] * v[2];
  out[1] = s[1] * v[0] + s[3] * v[1] + s[4] * v[2];
  out[2] = s[2] * v[0] + s[4] * v[1] + s[5] * v[2];
}

/// Adds to dL by the 2-D covariance what comes through the anti-aliasing factor: the logarithm of it is half
/// of ln det(cov - low_pass I) - ln det cov.
template <typename T>
EDGESPLAT_HOST_DEVICE inline void shrink_backward(const T* conic, T low_pass, T by_log_shrink, T* by_cov) {
  const T inverse = 1 / (conic[0] * conic[2] - conic[1] * conic[1]);  // det of the covariance
  const T xx = conic[2] * inverse - low_pass, yy = conic[0] * inverse - low_pass, xy = -conic[1] * inverse;
  const T det = xx * yy - xy * xy;
  const T least = T(1e-6) * inverse;
  const T own = 1 / (det > least ? det : least);
  by_cov[0] += T(0.5) * by_log_shrink * (yy * own - conic[0]);
  by_cov[1] += by_log_shrink * (-xy * own - conic[1]);
  by_cov[2] += T(0.5) * by_log_shrink * (xx * own - conic[2]);
}

/// dL by the 2-D covariance, xy counted once.
template <typename T>
EDGESPLAT_HOST_DEVICE inline void covariance2d_backward(const splat::CameraT<T>& c, const T* conic,
                                                        const SplatGradient<T>& by, T low_pass, T* by_cov) {
  inverse2d_backward(conic, by.conic, by_cov);
  shrink_backward(conic, low_pass, c.antialias * by.log_opacity, by_cov);
}

/// From dL by the 2-D covariance to dL by the rows a, b of J W and by the 3-D covariance.
template <typename T>
EDGESPLAT_HOST_DEVICE inline void spread_backward(const T* a, const T* b, const T* cov3d, const T* by_cov,
                                                  T* by_a, T* by_b, T* by_cov3d) {
  const T half_xy = by_cov[1] / 2;
  int k = 0;
  EDGESPLAT_UNROLL
  for (int i = 0; i < 3; ++i) {
    EDGESPLAT_UNROLL
    for (int j = i; j < 3; ++j) {
      by_cov3d[k++] =
          by_cov[0] * a[i] * a[j] + half_xy * (a[i] * b[j] + a[j] * b[i]) + by_cov[2] * b[i] * b[j];
    }
  }
  T sa[3], sb[3];
  symmetric_times(cov3d, a, sa);
  symmetric_times(cov3d, b, sb);
  EDGESPLAT_UNROLL
  for (int i = 0; i < 3; ++i) {
    by_a[i] = 2 * by_cov[0] * sa[i] + by_cov[1] * sb[i];
    by_b[i] = by_cov[1] * sa[i] + 2 * by_cov[2] * sb[i];
  }
}

/// `conic` is what splat::project gave for the same mean, covariance and low-pass; the Gaussian must have
/// passed its tests. Writes all of `out`. Of a pinhole: see project_backward_any.
template <typename T>
EDGESPLAT_HOST_DEVICE inline void project_backward(const splat::CameraT<T>& c, const T* mean, const T* cov3d,
                                                   const T* conic, const SplatGradient<T>& by, T low_pass,
                                                   ProjectBackward<T>& out) {
  const T* r = c.rotation;
  T p[3];
  EDGESPLAT_UNROLL
  for (int i = 0; i < 3; ++i) {
    p[i] = r[3 * i] * mean[0] + r[3 * i + 1] * mean[1] + r[3 * i + 2] * mean[2] + c.translation[i];
  }
  const T inv_z = 1 / p[2];
  const T x_limit = T(1.3) * c.tan_x, y_limit = T(1.3) * c.tan_y;
  const T x_free = p[0] * inv_z, y_free = p[1] * inv_z;
  const T x = x_free < -x_limit ? -x_limit : (x_free > x_limit ? x_limit : x_free);
  const T y = y_free < -y_limit ? -y_limit : (y_free > y_limit ? y_limit : y_free);
  const T fx_z = c.fx * inv_z, fy_z = c.fy * inv_z;
  T a[3], b[3];  // rows of J W
  EDGESPLAT_UNROLL
  for (int i = 0; i < 3; ++i) {
    a[i] = fx_z * (r[i] - x * r[6 + i]);
    b[i] = fy_z * (r[3 + i] - y * r[6 + i]);
  }
  T by_cov[3], by_a[3], by_b[3];
  covariance2d_backward(c, conic, by, low_pass, by_cov);
  spread_backward(a, b, cov3d, by_cov, by_a, by_b, out.cov3d);
  T a_along = 0, b_along = 0, by_x = 0, by_y = 0;
  EDGESPLAT_UNROLL
  for (int i = 0; i < 3; ++i) {
    a_along += a[i] * by_a[i];
    b_along += b[i] * by_b[i];
    by_x -= fx_z * r[6 + i] * by_a[i];
    by_y -= fy_z * r[6 + i] * by_b[i];
  }
  // Where the clamp of the forward pass holds, the direction of the Jacobian does not move.
  by_x = x == x_free ? by_x : T(0);
  by_y = y == y_free ? by_y : T(0);
  T by_p[3];
  by_p[0] = fx_z * by.u + inv_z * by_x;
  by_p[1] = fy_z * by.v + inv_z * by_y;
  by_p[2] = by.depth - inv_z * (fx_z * p[0] * by.u + fy_z * p[1] * by.v + a_along + b_along + x_free * by_x +
                                y_free * by_y);
  EDGESPLAT_UNROLL
  for (int i = 0; i < 3; ++i) out.mean[i] = r[i] * by_p[0] + r[3 + i] * by_p[1] + r[6 + i] * by_p[2];
  // dL by the rows of the rotation: from the Jacobian and from p = R m + t. A row g of it turns the camera by
  // g x r.
  T turn[3] = {0, 0, 0};
  EDGESPLAT_UNROLL
  for (int row = 0; row < 3; ++row) {
    T g[3], axis[3];
    EDGESPLAT_UNROLL
    for (int i = 0; i < 3; ++i) {
      const T jacobian = row == 0 ? fx_z * by_a[i]
                                  : (row == 1 ? fy_z * by_b[i] : -(x * fx_z * by_a[i] + y * fy_z * by_b[i]));
      g[i] = jacobian + by_p[row] * mean[i];
    }
    cross(g, r + 3 * row, axis);
    EDGESPLAT_UNROLL
    for (int i = 0; i < 3; ++i) turn[i] += axis[i];
  }
  EDGESPLAT_UNROLL
  for (int i = 0; i < 3; ++i) {
    out.pose[i] = turn[i];
    out.pose[3 + i] = by_p[i];
  }
}

/// The same of an equidistant fisheye (splat::project_fisheye).
template <typename T>
EDGESPLAT_HOST_DEVICE inline void project_fisheye_backward(const splat::CameraT<T>& c, const T* mean,
                                                           const T* cov3d, const T* conic,
                                                           const SplatGradient<T>& by, T low_pass,
                                                           ProjectBackward<T>& out) {
  const T* r = c.rotation;
  T p[3], j[2][3], a[3], b[3];
  splat::to_camera(c, mean, p);
  const splat::Fisheye<T> f = splat::fisheye_at(p);
  splat::fisheye_jacobian(c, p, f, j[0], j[1]);
  for (int i = 0; i < 3; ++i) {
    a[i] = j[0][0] * r[i] + j[0][1] * r[3 + i] + j[0][2] * r[6 + i];
    b[i] = j[1][0] * r[i] + j[1][1] * r[3 + i] + j[1][2] * r[6 + i];
  }
  T by_cov[3], by_a[3], by_b[3];
  covariance2d_backward(c, conic, by, low_pass, by_cov);
  spread_backward(a, b, cov3d, by_cov, by_a, by_b, out.cov3d);
  T by_j[2][3];
  for (int k = 0; k < 3; ++k) {
    by_j[0][k] = by_a[0] * r[3 * k] + by_a[1] * r[3 * k + 1] + by_a[2] * r[3 * k + 2];
    by_j[1][k] = by_b[0] * r[3 * k] + by_b[1] * r[3 * k + 1] + by_b[2] * r[3 * k + 2];
  }
  const T x = p[0], y = p[1], z = p[2], d = f.d, g = f.g, h = f.h;
  // Second derivatives of x s and of y s: `mixed` are those by x, x, y and by x, y, y.
  const T mixed_xxy = y * (g + h * x * x), mixed_xyy = x * (g + h * y * y);
  const T xxz = -1 / d + 2 * x * x / (d * d), xyz = 2 * x * y / (d * d), yyz = -1 / d + 2 * y * y / (d * d);
  const T xzz = 2 * x * z / (d * d), yzz = 2 * y * z / (d * d);
  const T xxx = x * (3 * g + h * x * x), yyy = y * (3 * g + h * y * y);
  const T gu[3] = {c.fx * by_j[0][0], c.fx * by_j[0][1], c.fx * by_j[0][2]};
  const T gv[3] = {c.fy * by_j[1][0], c.fy * by_j[1][1], c.fy * by_j[1][2]};
  T by_p[3];
  by_p[0] =
      gu[0] * xxx + gu[1] * mixed_xxy + gu[2] * xxz + gv[0] * mixed_xxy + gv[1] * mixed_xyy + gv[2] * xyz;
  by_p[1] =
      gu[0] * mixed_xxy + gu[1] * mixed_xyy + gu[2] * xyz + gv[0] * mixed_xyy + gv[1] * yyy + gv[2] * yyz;
  by_p[2] = gu[0] * xxz + gu[1] * xyz + gu[2] * xzz + gv[0] * xyz + gv[1] * yyz + gv[2] * yzz;
  const T distance = std::sqrt(d);
  for (int i = 0; i < 3; ++i) by_p[i] += by.u * j[0][i] + by.v * j[1][i] + by.depth * p[i] / distance;
  for (int i = 0; i < 3; ++i) out.mean[i] = r[i] * by_p[0] + r[3 + i] * by_p[1] + r[6 + i] * by_p[2];
  T turn[3] = {0, 0, 0};
  for (int row = 0; row < 3; ++row) {
    T by_row[3], axis[3];
    for (int i = 0; i < 3; ++i) by_row[i] = j[0][row] * by_a[i] + j[1][row] * by_b[i] + by_p[row] * mean[i];
    cross(by_row, r + 3 * row, axis);
    for (int i = 0; i < 3; ++i) turn[i] += axis[i];
  }
  for (int i = 0; i < 3; ++i) {
    out.pose[i] = turn[i];
    out.pose[3 + i] = by_p[i];
  }
}

/// The reverse of splat::project_any.
template <typename T>
EDGESPLAT_HOST_DEVICE inline void project_backward_any(const splat::CameraT<T>& c, const T* mean,
                                                       const T* cov3d, const T* conic,
                                                       const SplatGradient<T>& by, T low_pass,
                                                       ProjectBackward<T>& out) {
  if (c.fisheye) {
    project_fisheye_backward(c, mean, cov3d, conic, by, low_pass, out);
  } else {
    project_backward(c, mean, cov3d, conic, by, low_pass, out);
  }
}

}  // namespace edgesplat::train
