// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/world/material.hpp"

#include <Eigen/Core>

namespace edgesplat::simulate {

/// Where a texture is looked up.
struct TexturePoint {
  Eigen::Vector2d uv_m;
  double footprint_m = 0.0;  ///< averaged over a square of this side
};

/// Diffuse colour of a surface, 0..1. kWindowView and kPane have none of their own: see shading.hpp.
[[nodiscard]] Rgb albedo(const Material& material, const TexturePoint& at);

/// Posters and signs: material.period_m is the width of the sheet; a poster's height is 1.4 times that.
[[nodiscard]] Rgb poster_albedo(const Material& material, const TexturePoint& at);
[[nodiscard]] Rgb sign_albedo(const Material& material, const TexturePoint& at);

}  // namespace edgesplat::simulate
