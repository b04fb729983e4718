// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace edgesplat::simulate {

using Rgb = Eigen::Vector3f;  ///< linear, 1 = white paper

/// How a surface is painted; what `base`, `accent` and `period_m` mean for each is said in pattern.cpp.
enum class Pattern : std::uint8_t {
  kPlaster,  ///< painted wall: nearly even, faint roller marks and grain
  kTiles,    ///< square tiles of side period_m with joints of the accent colour, each of its own shade
  kPavers,   ///< rectangular stones in rows set off by half
  kBricks,
  kWood,      ///< boards along v
  kMetal,     ///< brushed along u
  kConcrete,  ///< blotches, pores, shutter joints every period_m
  kAsphalt,   ///< dark stones in bitumen
  kFoliage,   ///< leaves of two greens
  kBark,
  kFabric,      ///< weave with stripes of the accent colour
  kPaint,       ///< car paint, plastic: even
  kPoster,      ///< printed picture with headline and text
  kSign,        ///< a short word or number on a plate
  kLamp,        ///< gives light
  kWindowView,  ///< a window of the house seen from inside: the landscape outside
  kPane,        ///< a window seen from outside: dark, mirrors the sky
  kTunnelWall,  ///< painted vault: pale below a band, marks every period_m, soot
  kRoadMarks,   ///< asphalt with a dashed line along u in the middle of v
};

struct Material {
  Pattern pattern = Pattern::kPaint;
  Rgb base = Rgb::Constant(0.5F);
  Rgb accent = Rgb::Constant(0.5F);
  float period_m = 1.0F;
  float contrast = 0.1F;      ///< amplitude of the noise relative to the colour
  float reflectivity = 0.5F;  ///< at 905 nm, 0..1
  std::uint32_t seed = 0;
  float glow = 0.0F;    ///< radiance of a lamp's own light
  float line_m = 0.0F;  ///< kRoadMarks: v of the line; kTunnelWall: u of the vault's top
};

}  // namespace edgesplat::simulate
