// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/project_math.hpp"

namespace edgesplat::splat {

/// The equidistant fisheye (Kannala-Brandt without distortion): u = fx x s + cx, v = fy y s + cy with s =
/// theta / r, theta the angle between the point p = (x, y, z) and the axis, r = |(x, y)|. Host and device,
/// any precision.
template <typename T>
struct Fisheye {
  T s;  ///< theta / r
  T g;  ///< (ds/dr) / r
  T h;  ///< (dg/dr) / r
  T d;  ///< |p|^2
};

/// Further from the axis than this nothing is drawn: towards the back the picture of a Gaussian is no
/// ellipse.
inline constexpr double kFisheyeMostAngle_rad = 1.9;

template <typename T>
EDGESPLAT_HOST_DEVICE inline Fisheye<T> fisheye_at(const T* p) {
  Fisheye<T> out;
  const T r2 = p[0] * p[0] + p[1] * p[1], z = p[2];
  out.d = r2 + z * z;
  const T q = r2 / (z * z);
  if (z > T(0) && q < T(0.03)) {  // series in q = (r / z)^2: the closed form cancels there
    const T inverse = 1 / z, cube = inverse * inverse * inverse;
    out.s =
        inverse *
        (1 + q * (T(-1.0 / 3) + q * (T(1.0 / 5) + q * (T(-1.0 / 7) + q * (T(1.0 / 9) - q * T(1.0 / 11))))));
    out.g = cube * (T(-2.0 / 3) + q * (T(4.0 / 5) + q * (T(-6.0 / 7) + q * (T(8.0 / 9) - q * T(10.0 / 11)))));
    out.h = cube * inverse * inverse *
            (T(8.0 / 5) + q * (T(-24.0 / 7) + q * (T(48.0 / 9) + q * (T(-80.0 / 11) + q * T(120.0 / 13)))));
    return out;
  }
  const T r = std::sqrt(r2);
  out.s = std::atan2(r, z) / r;
  out.g = (z / out.d - out.s) / r2;
  out.h = (-2 * z / (out.d * out.d) - 3 * out.g) / r2;
  return out;
}

/// J = d(u, v)/d(p), rows of 3.
template <typename T>
EDGESPLAT_HOST_DEVICE inline void fisheye_jacobian(const CameraT<T>& c, const T* p, const Fisheye<T>& f,
                                                   T* ju, T* jv) {
  ju[0] = c.fx * (f.s + f.g * p[0] * p[0]);
  ju[1] = c.fx * f.g * p[0] * p[1];
  ju[2] = -c.fx * p[0] / f.d;
  jv[0] = c.fy * f.g * p[0] * p[1];
  jv[1] = c.fy * (f.s + f.g * p[1] * p[1]);
  jv[2] = -c.fy * p[1] / f.d;
}

/// As project(). Nearness and depth are those from the camera's centre.
template <typename T>
EDGESPLAT_HOST_DEVICE inline bool project_fisheye(const CameraT<T>& c, const T* mean, const T* cov3d,
                                                  T near_m, T low_pass, Projection<T>& out) {
  const T* r = c.rotation;
  to_camera(c, mean, out.p);
  const T* p = out.p;
  const Fisheye<T> f = fisheye_at(p);
  out.depth = std::sqrt(f.d);
  out.u = c.fx * p[0] * f.s + c.cx;
  out.v = c.fy * p[1] * f.s + c.cy;
  T ju[3], jv[3], a[3], b[3];
  fisheye_jacobian(c, p, f, ju, jv);
  for (int i = 0; i < 3; ++i) {
    a[i] = ju[0] * r[i] + ju[1] * r[3 + i] + ju[2] * r[6 + i];
    b[i] = jv[0] * r[i] + jv[1] * r[3 + i] + jv[2] * r[6 + i];
  }
  const bool regular = spread(c, a, b, cov3d, low_pass, out);
  const T angle = f.s * std::sqrt(p[0] * p[0] + p[1] * p[1]);
  return out.depth > near_m && angle < T(kFisheyeMostAngle_rad) && regular;
}

template <typename T>
EDGESPLAT_HOST_DEVICE inline bool project_any(const CameraT<T>& c, const T* mean, const T* cov3d, T near_m,
                                              T low_pass, Projection<T>& out) {
  return c.fisheye ? project_fisheye(c, mean, cov3d, near_m, low_pass, out)
                   : project(c, mean, cov3d, near_m, low_pass, out);
}

}  // namespace edgesplat::splat
