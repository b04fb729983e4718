// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/host_device.hpp"
#include "kernels/splat/exp_fast.hpp"
#include "kernels/splat/log_fast.hpp"
#include "kernels/splat/splat_one.hpp"

#include <algorithm>

namespace edgesplat::splat {

/// Sixteen Gaussians side by side on their way to the screen, so that the maths of one becomes vector
/// operations of all: what splat_one does, but for the colour.
struct SplatLanes {
  static constexpr int kLanes = 16;
  using Lane = float[kLanes];

  Lane mean[3], log_scale[3], quat[4], opacity_logit;                    ///< in
  Lane growth;                                                           ///< growth_of(), where thinned
  Lane u, v, conic[3], opacity, depth, half_width, half_height, reach2;  ///< out
  Lane finite;   ///< 1 where the parameters are, else 0
  Lane visible;  ///< 1 where the picture shows something of it, else 0

  /// For project_one<., true>; in a loop of its own, which the compiler then makes vectors of.
  EDGESPLAT_INLINE void thin_one(const CameraT<float>& camera, int i) {
    constexpr float kLog2e = 1.44269504F;
    const float m[3] = {mean[0][i], mean[1][i], mean[2][i]};
    float scale[3];
    EDGESPLAT_UNROLL
    for (int k = 0; k < 3; ++k)
      scale[k] = exp2_fast(std::min(std::max(kLog2e * log_scale[k][i], -100.0F), 100.0F));
    growth[i] = growth_of(camera, m, scale, lot_of(m[0], m[1], m[2]));
  }

  /// `width` and `height` of the picture; kThin: where camera.least_axis_px > 0.
  template <bool kFisheye, bool kThin>
  EDGESPLAT_INLINE void project_one(const CameraT<float>& camera, float near_m, float low_pass, float width,
                                    float height, int i) {
    constexpr float kLog2e = 1.44269504F;
    const float m[3] = {mean[0][i], mean[1][i], mean[2][i]};
    const float q[4] = {quat[0][i], quat[1][i], quat[2][i], quat[3][i]};
    const float logit = opacity_logit[i];
    float apart = (logit - logit) + (m[0] - m[0]) + (m[1] - m[1]) + (m[2] - m[2]);
    EDGESPLAT_UNROLL
    for (const float part : q) apart += part - part;
    float scale[3];
    EDGESPLAT_UNROLL
    for (int k = 0; k < 3; ++k) {
      apart += log_scale[k][i] - log_scale[k][i];
      scale[k] = exp2_fast(std::min(std::max(kLog2e * log_scale[k][i], -100.0F), 100.0F));
    }
    // NaN minus itself is not 0, nor is infinity minus itself.
    const bool all_finite = apart == 0.0F;
    const float of_one = 1.0F / (1.0F + exp2_fast(std::min(std::max(-kLog2e * logit, -100.0F), 100.0F)));
    float grown = 1.0F;
    if constexpr (kThin) {
      grown = growth[i];
      EDGESPLAT_UNROLL
      for (float& axis : scale) axis *= grown;
    }
    float cov3d[6];
    covariance3d_of_scale(q, scale, cov3d);
    Projection<float> p;
    bool in_front = false;
    if constexpr (kFisheye) {
      in_front = project_fisheye(camera, m, cov3d, near_m, low_pass, p);
    } else {
      in_front = project(camera, m, cov3d, near_m, low_pass, p);
    }
    const float faint = of_one * p.shrink;
    // alpha >= 1/255 only where the Mahalanobis distance squared is under 2 ln(255 opacity): the box around
    // that ellipse.
    const float reach = 2.0F * log_fast(std::max(faint, kMinAlpha) / kMinAlpha);
    const float wide = std::sqrt(reach * p.cov[0]), high = std::sqrt(reach * p.cov[2]);
    const float conic_apart =
        (p.conic[0] - p.conic[0]) + (p.conic[1] - p.conic[1]) + (p.conic[2] - p.conic[2]);
    const int inside = (p.u + wide > -0.5F ? 1 : 0) & (p.u - wide < width - 0.5F ? 1 : 0) &
                       (p.v + high > -0.5F ? 1 : 0) & (p.v - high < height - 0.5F ? 1 : 0);
    const int drawn = inside & (in_front ? 1 : 0) & (all_finite ? 1 : 0) & (conic_apart == 0.0F ? 1 : 0) &
                      (faint >= kMinAlpha ? 1 : 0) & (grown > 0.0F ? 1 : 0);
    u[i] = p.u;
    v[i] = p.v;
    EDGESPLAT_UNROLL
    for (int k = 0; k < 3; ++k) conic[k][i] = p.conic[k];
    opacity[i] = faint;
    depth[i] = p.depth;
    half_width[i] = wide;
    half_height[i] = high;
    reach2[i] = reach;
    finite[i] = all_finite ? 1.0F : 0.0F;
    visible[i] = drawn != 0 ? 1.0F : 0.0F;
  }
};

}  // namespace edgesplat::splat
