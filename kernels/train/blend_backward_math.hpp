// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/blend_math.hpp"
#include "kernels/train/splat_gradient.hpp"

namespace edgesplat::train {

/// Reverse of splat::blend_into for one pixel, for backends that give a pixel a thread of its own. As on the
/// CPU (blend_backward.cpp) it goes front to back and takes what lies behind a splat as what is left of the
/// pixel's total, so that it needs the pictures and no record of the forward pass. Host and device.

/// A pixel before the splats that are still to come.
struct ReversePixel {
  float transmittance = 1.0F;
  float rest = 0.0F;  ///< dL by picture times what the splats still to come and the background add
  float by_rgb[3] = {0.0F, 0.0F, 0.0F};
  float by_depth = 0.0F;
  bool full = false;
};

/// What one pixel says about one splat, to be added up: moments about its centre of g, dL by the exponent of
/// its falloff, and dL by what it adds.
enum SplatSum {
  kSumG,
  kSumGx,
  kSumGy,
  kSumGxx,
  kSumGxy,
  kSumGyy,
  kSumRed,
  kSumGreen,
  kSumBlue,
  kSumDepth,
  kSumWeight,
  kSplatSums
};
/// Floats from one splat's sums to the next's: a multiple of 16 bytes.
inline constexpr int kSumStride = 12;

/// Everything in front of a pixel: what was drawn there and dL by it; by_depth and by_alpha 0 where there are
/// none.
EDGESPLAT_HOST_DEVICE inline ReversePixel reverse_pixel(const float* colour, float depth_sum_m, float alpha,
                                                        const float* by_colour, float by_depth,
                                                        float by_alpha) {
  ReversePixel pixel;
  for (int c = 0; c < 3; ++c) pixel.by_rgb[c] = by_colour[c];
  pixel.by_depth = by_depth;
  // All that the splats and the background add; alpha is 1 - transmittance.
  pixel.rest = by_colour[0] * colour[0] + by_colour[1] * colour[1] + by_colour[2] * colour[2] +
               by_depth * depth_sum_m - by_alpha * (1.0F - alpha);
  return pixel;
}

/// Takes one splat off the pixel, whose centre lies at (dx, dy) from the splat's, and writes the first
/// kSplatSums of `sums`. False, and nothing written, where the splat adds nothing. With T the transmittance
/// before it, q = dL by picture times what it would add at weight 1, R the rest behind it: dL/dalpha = T q -
/// R / (1 - alpha).
EDGESPLAT_HOST_DEVICE inline bool reverse_into(const splat::BlendRecord& s, float dx, float dy,
                                               ReversePixel& pixel, float* sums) {
  const float raw = splat::raw_alpha(s, dx, dy);
  if (pixel.full || raw < splat::kMinAlpha) return false;
  const float alpha = raw < splat::kMaxAlpha ? raw : splat::kMaxAlpha;
  const float before = pixel.transmittance;
  const float after = before * (1.0F - alpha);
  if (after < splat::kMinTransmittance) {
    pixel.full = true;
    return false;
  }
  const float weight = alpha * before;
  const float q = pixel.by_rgb[0] * s.rgb[0] + pixel.by_rgb[1] * s.rgb[1] + pixel.by_rgb[2] * s.rgb[2] +
                  pixel.by_depth * s.depth_m;
  pixel.rest -= weight * q;
  pixel.transmittance = after;
  // Constant where it is cut.
  const float g = raw < splat::kMaxAlpha ? alpha * (before * q - pixel.rest / (1.0F - alpha)) : 0.0F;
  const float gx = g * dx, gy = g * dy;
  sums[kSumG] = g;
  sums[kSumGx] = gx;
  sums[kSumGy] = gy;
  sums[kSumGxx] = gx * dx;
  sums[kSumGxy] = gx * dy;
  sums[kSumGyy] = gy * dy;
  sums[kSumRed] = weight * pixel.by_rgb[0];
  sums[kSumGreen] = weight * pixel.by_rgb[1];
  sums[kSumBlue] = weight * pixel.by_rgb[2];
  sums[kSumDepth] = weight * pixel.by_depth;
  sums[kSumWeight] = weight;
  return true;
}

/// dL by the splat from the sums over all pixels: alpha = opacity exp(-(xx dx^2 / 2 + xy dx dy + yy dy^2 /
/// 2)) with dx = x - u.
EDGESPLAT_HOST_DEVICE inline SplatGradient<float> splat_gradient(const splat::Splat& s, const float* sums) {
  SplatGradient<float> by;
  by.u = s.conic[0] * sums[kSumGx] + s.conic[1] * sums[kSumGy];
  by.v = s.conic[1] * sums[kSumGx] + s.conic[2] * sums[kSumGy];
  by.conic[0] = -0.5F * sums[kSumGxx];
  by.conic[1] = -sums[kSumGxy];
  by.conic[2] = -0.5F * sums[kSumGyy];
  by.opacity = sums[kSumG] / s.opacity;
  for (int c = 0; c < 3; ++c) by.rgb[c] = sums[kSumRed + c];
  by.depth = sums[kSumDepth];
  return by;
}

}  // namespace edgesplat::train
