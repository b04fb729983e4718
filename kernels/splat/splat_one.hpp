// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/fisheye_math.hpp"
#include "kernels/splat/project.hpp"
#include "kernels/splat/sh_math.hpp"
#include "kernels/splat/thin_math.hpp"

namespace edgesplat::splat {

enum class SplatOutcome : std::uint8_t { kVisible, kCulled, kNotFinite };

/// Alpha under which a Gaussian leaves no trace in an 8-bit picture.
inline constexpr float kMinAlpha = 1.0F / 255.0F;

struct SplatInput {
  const float* mean;
  const float* log_scale;
  const float* quat;
  float opacity_logit;
  const float* sh;
  int sh_degree;
};

inline CameraT<float> camera_of(const View& view, const RenderOptions& options) {
  CameraT<float> camera{};
  camera.fisheye = view.fisheye;
  camera.antialias = options.antialiased ? 1.0F : 0.0F;
  camera.least_axis_px = options.least_axis_px;
  camera.fx = view.fx_px;
  camera.fy = view.fy_px;
  camera.cx = view.cx_px;
  camera.cy = view.cy_px;
  camera.tan_x = 0.5F * static_cast<float>(view.width_px) / view.fx_px;
  camera.tan_y = 0.5F * static_cast<float>(view.height_px) / view.fy_px;
  for (int i = 0; i < 9; ++i) camera.rotation[i] = view.rotation[static_cast<std::size_t>(i)];
  for (int i = 0; i < 3; ++i) camera.translation[i] = view.translation[static_cast<std::size_t>(i)];
  return camera;
}

EDGESPLAT_HOST_DEVICE inline bool all_finite(const float* values, int count) {
  for (int i = 0; i < count; ++i) {
    if (!(values[i] - values[i] == 0.0F)) return false;  // NaN and infinity minus themselves are NaN
  }
  return true;
}

/// Colour towards the camera: 0.5 + SH, not below 0.
EDGESPLAT_HOST_DEVICE inline void colour_towards(const SplatInput& in, const float* camera_position,
                                                 float* rgb) {
  float d[3] = {in.mean[0] - camera_position[0], in.mean[1] - camera_position[1],
                in.mean[2] - camera_position[2]};
  const float length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  for (float& axis : d) axis /= length;
  float basis[16];
  sh_basis(in.sh_degree, d[0], d[1], d[2], basis);
  const int terms = (in.sh_degree + 1) * (in.sh_degree + 1);
  for (int c = 0; c < 3; ++c) {
    float value = 0.5F;
    for (int k = 0; k < terms; ++k) value += basis[k] * in.sh[3 * k + c];
    rgb[c] = value > 0.0F ? value : 0.0F;
  }
}

/// Where one Gaussian of finite parameters lies on the screen: all of `out` but its colour and row. False
/// where the picture does not show it.
EDGESPLAT_HOST_DEVICE inline bool shape_of(const SplatInput& in, const CameraT<float>& camera, float near_m,
                                           float low_pass, float width_px, float height_px, Splat& out) {
  out.opacity = 1.0F / (1.0F + std::exp(-in.opacity_logit));
  if (out.opacity < kMinAlpha) return false;
  float scale[3] = {std::exp(in.log_scale[0]), std::exp(in.log_scale[1]), std::exp(in.log_scale[2])};
  if (camera.least_axis_px > 0.0F) {
    const float grown = growth_of(camera, in.mean, scale, lot_of(in.mean[0], in.mean[1], in.mean[2]));
    if (grown == 0.0F) return false;
    EDGESPLAT_UNROLL
    for (float& axis : scale) axis *= grown;
  }
  float cov3d[6];
  covariance3d_of_scale(in.quat, scale, cov3d);
  Projection<float> p;
  if (!project_any(camera, in.mean, cov3d, near_m, low_pass, p)) return false;
  out.opacity *= p.shrink;
  if (!(out.opacity >= kMinAlpha)) return false;
  // alpha >= 1/255 only where the Mahalanobis distance squared is under 2 ln(255 opacity): the box around
  // that ellipse.
  out.reach2 = 2.0F * std::log(out.opacity / kMinAlpha);
  out.half_width_px = std::sqrt(out.reach2 * p.cov[0]);
  out.half_height_px = std::sqrt(out.reach2 * p.cov[2]);
  const bool outside = !(p.u + out.half_width_px > -0.5F) || !(p.u - out.half_width_px < width_px - 0.5F) ||
                       !(p.v + out.half_height_px > -0.5F) || !(p.v - out.half_height_px < height_px - 0.5F);
  if (outside || !all_finite(p.conic, 3)) return false;
  out.u_px = p.u;
  out.v_px = p.v;
  for (int i = 0; i < 3; ++i) out.conic[i] = p.conic[i];
  out.depth_m = p.depth;
  return true;
}

/// The whole way of one Gaussian to the screen; host and device.
EDGESPLAT_HOST_DEVICE inline SplatOutcome splat_one(const SplatInput& in, const CameraT<float>& camera,
                                                    const float* camera_position, float near_m,
                                                    float low_pass, float width_px, float height_px,
                                                    Splat& out) {
  const int sh_floats = 3 * (in.sh_degree + 1) * (in.sh_degree + 1);
  if (!all_finite(in.mean, 3) || !all_finite(in.log_scale, 3) || !all_finite(in.quat, 4) ||
      !all_finite(&in.opacity_logit, 1) || !all_finite(in.sh, sh_floats)) {
    return SplatOutcome::kNotFinite;
  }
  if (!shape_of(in, camera, near_m, low_pass, width_px, height_px, out)) return SplatOutcome::kCulled;
  colour_towards(in, camera_position, out.rgb);
  return SplatOutcome::kVisible;
}

}  // namespace edgesplat::splat
