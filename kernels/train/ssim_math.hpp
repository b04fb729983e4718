// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/host_device.hpp"

namespace edgesplat::train {

/// SSIM of one pixel and channel from its local moments, and its slopes. Host and device.

inline constexpr int kSsimRadius = 5;

/// exp(-d^2 / (2 1.5^2)) for |d| = 0..5, normalised over the window of 11.
EDGESPLAT_HOST_DEVICE inline float ssim_window(int distance) {
  constexpr float kWindow[kSsimRadius + 1] = {0.266011724862F, 0.213005537711F, 0.109360689510F,
                                              0.036000772128F, 0.007598758135F, 0.001028380084F};
  return kWindow[distance < 0 ? -distance : distance];
}

/// Window means of x, y, x^2 + y^2 and x y.
struct SsimMoments {
  float x, y, squares, product;
};

struct SsimSlopes {
  float similarity;
  float by_x, by_squares, by_product;  ///< of it by the moments; by that of y nobody asks
};

EDGESPLAT_HOST_DEVICE inline SsimSlopes ssim_slopes(const SsimMoments& m) {
  constexpr float kC1 = 0.01F * 0.01F;
  constexpr float kC2 = 0.03F * 0.03F;
  const float n1 = 2.0F * m.x * m.y + kC1;
  const float n2 = 2.0F * (m.product - m.x * m.y) + kC2;
  const float d1 = m.x * m.x + m.y * m.y + kC1;
  const float d2 = m.squares - m.x * m.x - m.y * m.y + kC2;
  const float inverse = 1.0F / (d1 * d2);
  const float s = n1 * n2 * inverse;
  return {s, 2.0F * (m.y * (n2 - n1) - m.x * s * (d2 - d1)) * inverse, -s * d1 * inverse,
          2.0F * n1 * inverse};
}

}  // namespace edgesplat::train
