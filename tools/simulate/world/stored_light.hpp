// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/world/static_scene.hpp"

#include <Eigen/Core>

#include <atomic>
#include <cstdint>
#include <vector>

namespace edgesplat::simulate {

/// Light that arrives at a point.
struct Irradiance {
  Rgb total = Rgb::Zero();
  float sun_share = 0.0F;  ///< of the total that comes straight from the sun, 0..1
};

/// Light at a surface point: what the lamps and the sun send straight there, with shadows of the static
/// scene, and ambient light, less of it in corners.
[[nodiscard]] Irradiance light_at(const StaticScene& still, const Eigen::Vector3d& p_in_world_m,
                                  const Eigen::Vector3d& normal);
/// A cheaper estimate for movers: no shadows of lamps, no corners.
[[nodiscard]] Irradiance open_light_at(const StaticScene& still, const Eigen::Vector3d& p_in_world_m,
                                       const Eigen::Vector3d& normal);

/// light_at() on a grid over every face of the static scene, each value computed when it is first asked for.
/// Thread-safe: a value is a pure function of its place, so that threads may race to store it.
class StoredLight {
 public:
  explicit StoredLight(const StaticScene& still);
  /// Between the four grid points around `uv_m`.
  [[nodiscard]] Irradiance at(std::uint32_t surface, const Eigen::Vector2d& uv_m) const;

 private:
  struct Face {
    std::uint32_t first = 0;  ///< in texels_
    std::uint16_t columns = 0;
    std::uint16_t rows = 0;
  };
  [[nodiscard]] Irradiance texel(std::uint32_t surface, const Face& face, int column, int row) const;
  const StaticScene& still_;
  std::vector<Face> faces_;                                 ///< by surface
  mutable std::vector<std::atomic<std::uint64_t>> texels_;  ///< 0 = not yet known
};

}  // namespace edgesplat::simulate
