// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/host_device.hpp"
#include "kernels/splat/exp_fast.hpp"
#include "kernels/train/covariance_backward_math.hpp"
#include "kernels/train/project_backward_math.hpp"

#include <algorithm>

namespace edgesplat::train {

/// Sixteen Gaussians side by side, so that the maths of one becomes vector operations of all.
struct GaussianLanes {
  static constexpr int kLanes = 16;
  using Lane = float[kLanes];

  Lane mean[3], log_scale[3], quat[4], opacity_logit, conic[3];             ///< in
  Lane by_u, by_v, by_conic[3], by_depth, by_log_opacity;                   ///< in
  Lane by_mean[3], by_log_scale[3], by_quat[4], by_opacity_logit, pose[6];  ///< out

  template <bool kFisheye>
  EDGESPLAT_INLINE void reverse_one(const splat::CameraT<float>& camera, float low_pass, int i) {
    const float m[3] = {mean[0][i], mean[1][i], mean[2][i]};
    const float q[4] = {quat[0][i], quat[1][i], quat[2][i], quat[3][i]};
    const float c[3] = {conic[0][i], conic[1][i], conic[2][i]};
    const SplatGradient<float> by{by_u[i],
                                  by_v[i],
                                  {by_conic[0][i], by_conic[1][i], by_conic[2][i]},
                                  0.0F,
                                  {0.0F, 0.0F, 0.0F},
                                  by_depth[i],
                                  by_log_opacity[i]};
    constexpr float kLog2e = 1.44269504F;
    float scale[3];
    EDGESPLAT_UNROLL
    for (int k = 0; k < 3; ++k)
      scale[k] = splat::exp2_fast(std::min(std::max(kLog2e * log_scale[k][i], -100.0F), 100.0F));
    float cov3d[6];
    splat::covariance3d_of_scale(q, scale, cov3d);
    ProjectBackward<float> out;
    if constexpr (kFisheye) {
      project_fisheye_backward(camera, m, cov3d, c, by, low_pass, out);
    } else {
      project_backward(camera, m, cov3d, c, by, low_pass, out);
    }
    // d ln(opacity) / d logit = 1 - opacity, without what anti-aliasing takes from it.
    const float to_logit = std::min(std::max(kLog2e * opacity_logit[i], -100.0F), 100.0F);
    by_opacity_logit[i] = by.log_opacity / (1.0F + splat::exp2_fast(to_logit));
    float to_quat[4], to_scale[3];
    covariance3d_backward(q, scale, out.cov3d, to_quat, to_scale);
    EDGESPLAT_UNROLL
    for (int k = 0; k < 3; ++k) {
      by_mean[k][i] = out.mean[k];
      by_log_scale[k][i] = to_scale[k];
    }
    EDGESPLAT_UNROLL
    for (int k = 0; k < 4; ++k) by_quat[k][i] = to_quat[k];
    EDGESPLAT_UNROLL
    for (int k = 0; k < 6; ++k) pose[k][i] = out.pose[k];
  }
};

template <bool kFisheye>
EDGESPLAT_INLINE void reverse_lanes_inline(const splat::CameraT<float>& camera_in, float low_pass,
                                           GaussianLanes& lanes) {
  const splat::CameraT<float> camera =
      camera_in;  // a copy: else the compiler fears that the lanes overlap it
  for (int i = 0; i < GaussianLanes::kLanes; ++i) lanes.reverse_one<kFisheye>(camera, low_pass, i);
}

}  // namespace edgesplat::train
