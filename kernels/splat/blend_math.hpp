// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/host_device.hpp"
#include "kernels/splat/blend.hpp"
#include "kernels/splat/splat_one.hpp"

#include <cmath>

namespace edgesplat::splat {

/// The blend of one splat into one pixel, for backends that give a pixel a thread of its own; the CPU's,
/// which takes 16 pixels at once, is pixel_alpha.hpp. Host and device.

/// A splat as a tile keeps it: opacity times falloff = 2^(top - (a dx^2 + b dx dy + c dy^2)).
struct alignas(16) BlendRecord {
  float u_px, v_px;
  float a, b, c;
  float top;
  float rgb[3];
  float depth_m;
  float unused[2];
};

EDGESPLAT_HOST_DEVICE inline BlendRecord blend_record(const Splat& s) {
  constexpr float kLog2e = 1.44269504F;
  constexpr float kLog2Of255 = 7.99435344F;
  BlendRecord r;
  r.u_px = s.u_px;
  r.v_px = s.v_px;
  r.a = 0.5F * kLog2e * s.conic[0];
  r.b = kLog2e * s.conic[1];
  r.c = 0.5F * kLog2e * s.conic[2];
  r.top = 0.5F * kLog2e * s.reach2 - kLog2Of255;  // reach2 = 2 ln(255 opacity)
  for (int i = 0; i < 3; ++i) r.rgb[i] = s.rgb[i];
  r.depth_m = s.depth_m;
  return r;
}

/// 2^x within a millionth, for x <= 0 and above -126.
EDGESPLAT_HOST_DEVICE inline float exp2_of_falloff(float x) {
#ifdef __CUDA_ARCH__
  float y;
  asm("ex2.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  return y;
#else
  return std::exp2(x);
#endif
}

/// Opacity times falloff, before it is cut at kMaxAlpha and dropped under kMinAlpha.
EDGESPLAT_HOST_DEVICE inline float raw_alpha(const BlendRecord& r, float dx, float dy) {
  const float form = (r.a * dx + r.b * dy) * dx + r.c * dy * dy;
  // Rounding may make the form of a needle negative.
  const float exponent = r.top - (form > 0.0F ? form : 0.0F);
  return exp2_of_falloff(exponent > -20.0F ? exponent : -20.0F);
}

/// Whether alpha may reach 1/255 at a pixel centre of [left, left + width] x [top, top + height]. The form is
/// convex, so its least value over a rectangle lies at the point nearest to the centre in x or in y, the
/// other coordinate being free. What is not a number counts as reached.
EDGESPLAT_HOST_DEVICE inline bool reaches_rectangle(const BlendRecord& r, float left, float top, float width,
                                                    float height) {
  constexpr float kLog2Of255 = 7.99435344F;
  const auto between = [](float value, float low, float high) {
    return value < low ? low : (value > high ? high : value);
  };
  const float x_low = left - r.u_px, y_low = top - r.v_px;
  const float x = between(0.0F, x_low, x_low + width), y = between(0.0F, y_low, y_low + height);
  const float y_of_x = between(-0.5F * r.b / r.c * x, y_low, y_low + height);
  const float x_of_y = between(-0.5F * r.b / r.a * y, x_low, x_low + width);
  const float at_x = (r.a * x + r.b * y_of_x) * x + r.c * y_of_x * y_of_x;
  const float at_y = (r.a * x_of_y + r.b * y) * x_of_y + r.c * y * y;
  const float least = at_x < at_y ? at_x : at_y;
  return !(least > (r.top + kLog2Of255) * 1.0001F + 1e-4F);
}

/// A pixel on its way through the splats in front of it.
struct BlendPixel {
  float transmittance = 1.0F;
  float rgb[3] = {0.0F, 0.0F, 0.0F};
  float depth_m = 0.0F;
  bool full = false;  ///< takes no further splat
};

/// Adds a splat whose centre lies at (-dx, -dy) from the pixel.
EDGESPLAT_HOST_DEVICE inline void blend_into(const BlendRecord& r, float dx, float dy, BlendPixel& pixel) {
  const float raw = raw_alpha(r, dx, dy);
  if (pixel.full || raw < kMinAlpha) return;
  const float alpha = raw < kMaxAlpha ? raw : kMaxAlpha;
  const float after = pixel.transmittance * (1.0F - alpha);
  if (after < kMinTransmittance) {
    pixel.full = true;
    return;
  }
  const float weight = alpha * pixel.transmittance;
  for (int i = 0; i < 3; ++i) pixel.rgb[i] += weight * r.rgb[i];
  pixel.depth_m += weight * r.depth_m;
  pixel.transmittance = after;
}

}  // namespace edgesplat::splat
