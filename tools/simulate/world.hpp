// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/geometry/rigid_transform.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace edgesplat::simulate {

struct WorldConfig {
  std::string name = "corridor";  ///< corridor, bare, loop, stairs, street, tunnel, square
  int pedestrians = 0;            ///< 0..100
  int cars = 0;                   ///< moving cars (street only), 0..50
  std::uint64_t seed = 1;         ///< decides every texture, pose and gait
};

/// Which surfaces a ray sees.
enum class Visibility : std::uint8_t {
  kEverything,
  kStaticOnly,  ///< movers removed: the clean truth
};

struct Ray {
  Eigen::Vector3d origin_m;   ///< world frame
  Eigen::Vector3d direction;  ///< unit
  double time_s = 0.0;        ///< simulation time at which the movers are posed
};

struct Hit {
  double range_m = 0.0;
  Eigen::Vector3d normal;     ///< unit, towards the ray's origin
  float reflectivity = 0.0F;  ///< at 905 nm, 0..1, before the angle of incidence
  std::uint32_t surface = 0;  ///< which static surface or mover part, for shading
  std::uint16_t mover = 0;    ///< 0 static, else 1 + index of the mover
  Eigen::Vector2d uv_m;       ///< texture coordinates, metres on the surface
};

/// One simulated place with its movers: the ground truth of the whole project. World frame: z up, metres.
/// Immutable after create() and thread-safe; the same config gives the same world on every machine.
class World {
 public:
  virtual ~World() = default;
  /// Errors: kInvalidConfig for an unknown name or a count out of range.
  static Result<std::unique_ptr<World>> create(const WorldConfig& config);

  /// Nearest surface in [0.05 m, 200 m], or nothing.
  [[nodiscard]] virtual std::optional<Hit> cast(const Ray& ray, Visibility visibility) const = 0;
  /// Linear RGB radiance, 1 = white paper in full light, that arrives along the ray from `hit` (nothing =
  /// sky). `footprint_m`: width of a pixel on the surface, for texture filtering.
  [[nodiscard]] virtual Eigen::Vector3f radiance(const Ray& ray, const std::optional<Hit>& hit,
                                                 double footprint_m, Visibility visibility) const = 0;
  /// How much of the light that falls on a static surface is left by the movers around it, 0..1; exactly 1
  /// where none is near: radiance(kEverything) = mover_shade * radiance(kStaticOnly) on static surfaces.
  [[nodiscard]] virtual float mover_shade(const Ray& /*ray*/, const Hit& /*hit*/) const { return 1.0F; }
  /// The same world with its movers held still as they are at `time_s`, whatever a ray's time: many times
  /// faster for a whole picture. Borrows this world. Nothing where holding gains nothing: use the world
  /// itself.
  [[nodiscard]] virtual std::unique_ptr<const World> frozen_at(double /*time_s*/) const { return nullptr; }

  /// Where the robot's body drives: corner points of a smooth path, z of the body included, and its speed.
  struct Path {
    std::vector<Eigen::Vector3d> waypoints_m;
    bool closed = false;
    double speed_mps = 1.2;
  };
  [[nodiscard]] virtual Path path() const = 0;
};

}  // namespace edgesplat::simulate
