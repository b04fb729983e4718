// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/project.hpp"

#include <cmath>

namespace edgesplat::splat {

/// A splat as the pixels of one tile ask it, x and y from the tile's centre (pixels):
/// opacity times falloff = 2^(power[0] + power[1] x + power[2] y + power[3] x^2 + power[4] x y + power[5]
/// y^2).
struct TileSplat {
  float power[6];
  float rgb[3];
  float depth_m;
};

/// The polynomial of a splat whose centre lies at (u, v) from the tile's.
template <typename T>
inline void set_power(const Splat& s, T u, T v, TileSplat& out) {
  constexpr auto kLog2e = static_cast<T>(1.4426950408889634);
  constexpr auto kLog2Of255 = static_cast<T>(7.994353436858858);
  const T a = T(0.5) * kLog2e * static_cast<T>(s.conic[0]);
  const T b = kLog2e * static_cast<T>(s.conic[1]);
  const T c = T(0.5) * kLog2e * static_cast<T>(s.conic[2]);
  // reach2 = 2 ln(255 opacity)
  const T top = T(0.5) * kLog2e * static_cast<T>(s.reach2) - kLog2Of255;
  const T au = a * u, bv = b * v, cv = c * v;
  out.power[0] = static_cast<float>(top - ((au + bv) * u + cv * v));
  out.power[1] = static_cast<float>(au + au + bv);
  out.power[2] = static_cast<float>(cv + cv + b * u);
  out.power[3] = static_cast<float>(-a);
  out.power[4] = static_cast<float>(-b);
  out.power[5] = static_cast<float>(-c);
}

/// Far from the centre of a needle large numbers cancel, hence double precision there; within the tile the
/// polynomial is small again.
inline void set_tile_splat(const Splat& s, float tile_x_px, float tile_y_px, TileSplat& out) {
  constexpr float kNear_px = 24.0F;
  const float u = s.u_px - tile_x_px, v = s.v_px - tile_y_px;
  if (std::abs(u) < kNear_px && std::abs(v) < kNear_px) {
    set_power(s, u, v, out);
  } else {
    set_power(s, static_cast<double>(s.u_px) - static_cast<double>(tile_x_px),
              static_cast<double>(s.v_px) - static_cast<double>(tile_y_px), out);
  }
  for (int k = 0; k < 3; ++k) out.rgb[k] = s.rgb[k];
  out.depth_m = s.depth_m;
}

}  // namespace edgesplat::splat
