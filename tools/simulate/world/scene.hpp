// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/world.hpp"
#include "tools/simulate/world/material.hpp"
#include "tools/simulate/world/primitive.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

namespace edgesplat::simulate {

/// A rectangle that shines downwards.
struct Lamp {
  Eigen::Vector3d centre_m;
  Eigen::Vector2d half_m;   ///< along x and y
  Rgb power = Rgb::Ones();  ///< irradiance one metre below it
};

struct Sun {
  Eigen::Vector3d towards;  ///< unit, from the ground to the sun
  Rgb irradiance = Rgb::Constant(0.7F);
};

/// Light of a place besides its materials. Irradiance 1 makes white paper look 1.
struct Light {
  std::vector<Lamp> lamps;
  std::optional<Sun> sun;
  Rgb ambient_up = Rgb::Constant(0.3F);    ///< falls on surfaces that look up
  Rgb ambient_down = Rgb::Constant(0.2F);  ///< falls on surfaces that look down
  double ambient_reach_m = 1.5;            ///< things nearer than this shade the ambient light
  double texel_m = 0.12;                   ///< of the stored light
};

/// Where movers walk or drive: a polyline, along which they go at one speed so that none meets another.
struct Lane {
  std::vector<Eigen::Vector3d> points_m;  ///< on the ground
  bool closed = false;                    ///< else movers begin again at the start
  double speed_mps = 1.0;                 ///< negative: from the end to the start
};

/// A place as plain data.
struct Scene {
  std::vector<Primitive> primitives;
  std::vector<Material> materials;
  Light light;
  World::Path path;
  std::vector<Lane> footways;
  std::vector<Lane> roads;

  std::uint32_t add(const Material& material) {
    materials.push_back(material);
    return static_cast<std::uint32_t>(materials.size() - 1);
  }
  /// Aligned box between two corners.
  void add_box(const Eigen::Vector3d& lo_m, const Eigen::Vector3d& hi_m, std::uint32_t material);
  /// Upright cylinder standing on `foot_m`.
  void add_pillar(const Eigen::Vector3d& foot_m, double radius_m, double height_m, std::uint32_t material);
  void add_ellipsoid(const Eigen::Vector3d& centre_m, const Eigen::Vector3d& half_m, std::uint32_t material);
  void add(const Primitive& primitive) { primitives.push_back(primitive); }
};

}  // namespace edgesplat::simulate
