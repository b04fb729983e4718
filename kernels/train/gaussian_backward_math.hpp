// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/splat_one.hpp"
#include "kernels/train/covariance_backward_math.hpp"
#include "kernels/train/parameter_row.hpp"
#include "kernels/train/project_backward_math.hpp"
#include "kernels/train/sh_backward_math.hpp"

#include <cmath>

namespace edgesplat::train {

/// Reverse of splat::splat_one for one Gaussian: writes a ParameterRow (padding 0) and dL by the camera's
/// pose, dr and dt with camera_from_map ⊞ (dr, dt) = (rotation Exp(dr), translation + dt). Zeros and false
/// where a value is not finite. Host and device; the CPU backend takes 16 Gaussians at once instead
/// (gaussian_lanes.hpp).
EDGESPLAT_HOST_DEVICE inline bool gaussian_backward_one(const splat::SplatInput& in,
                                                        const splat::CameraT<float>& camera,
                                                        const float* camera_position, const splat::Splat& s,
                                                        const SplatGradient<float>& by_splat, float low_pass,
                                                        float* row, float* pose) {
  SplatGradient<float> by = by_splat;
  by.log_opacity = by.opacity * s.opacity;
  const float scale[3] = {std::exp(in.log_scale[0]), std::exp(in.log_scale[1]), std::exp(in.log_scale[2])};
  float cov3d[6];
  splat::covariance3d_of_scale(in.quat, scale, cov3d);
  ProjectBackward<float> out;
  project_backward_any(camera, in.mean, cov3d, s.conic, by, low_pass, out);
  for (int k = 0; k < 3; ++k) row[ParameterRow::kMean + static_cast<std::size_t>(k)] = out.mean[k];
  for (int k = 0; k < 6; ++k) pose[k] = out.pose[k];
  covariance3d_backward(in.quat, scale, out.cov3d, row + ParameterRow::kQuat, row + ParameterRow::kLogScale);
  // d ln(opacity) / d logit = 1 - opacity, without what anti-aliasing takes from it.
  row[ParameterRow::kOpacity] = by.log_opacity / (1.0F + std::exp(in.opacity_logit));
  const float offset[3] = {in.mean[0] - camera_position[0], in.mean[1] - camera_position[1],
                           in.mean[2] - camera_position[2]};
  float by_offset[3];
  colour_backward(in.sh_degree, offset, in.sh, s.rgb, by.rgb, row + ParameterRow::kSh, by_offset);
  if (in.sh_degree > 0) {
    const float by_position[3] = {-by_offset[0], -by_offset[1], -by_offset[2]};
    // The camera's position -R^T t goes with the pose as well: dr turns it by position x dr, dt moves it by
    // -R^T dt.
    float turn[3];
    cross(by_position, camera_position, turn);
    const float* r = camera.rotation;
    for (int k = 0; k < 3; ++k) {
      row[ParameterRow::kMean + static_cast<std::size_t>(k)] += by_offset[k];
      pose[k] += turn[k];
      pose[3 + k] += r[3 * k] * by_offset[0] + r[3 * k + 1] * by_offset[1] + r[3 * k + 2] * by_offset[2];
    }
  }
  const auto used = static_cast<int>(ParameterRow::kSh) + 3 * (in.sh_degree + 1) * (in.sh_degree + 1);
  constexpr auto kLanes = static_cast<int>(ParameterRow::kLanes);
  const int stride = (used + kLanes - 1) / kLanes * kLanes;
  const bool finite = splat::all_finite(row, used) && splat::all_finite(pose, 6);
  for (int k = finite ? used : 0; k < stride; ++k) row[k] = 0.0F;
  for (int k = finite ? 6 : 0; k < 6; ++k) pose[k] = 0.0F;
  return finite;
}

}  // namespace edgesplat::train
