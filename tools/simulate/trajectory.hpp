// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "tools/simulate/body_spline.hpp"
#include "tools/simulate/world.hpp"

#include <Eigen/Core>

#include <cstdint>

namespace edgesplat::simulate {

struct TrajectoryConfig {
  double duration_s = 20.0;            ///< (0, 36000]
  double standstill_s = 1.5;           ///< at the start, so that gravity can be found, >= 0
  double acceleration_mps2 = 0.8;      ///< of starting and braking, > 0
  double turn_rate_limit_radps = 0.8;  ///< the robot slows down in turns to keep this, > 0
  double body_motion = 1.0;            ///< scale of sway and bumps, 0 = a rail
  double spin_radps = 0.0;             ///< turns on itself while it drives, one way and the other, [0, 6]
  std::uint64_t seed = 1;
};

/// Everything an inertial sensor at the body's origin feels.
struct BodyState {
  geometry::RigidTransform world_from_body;
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();            ///< in the world frame
  Eigen::Vector3d acceleration_mps2 = Eigen::Vector3d::Zero();       ///< in the world frame, without gravity
  Eigen::Vector3d angular_velocity_radps = Eigen::Vector3d::Zero();  ///< in the body frame
};

/// How a wheeled robot drives along a world's path: stands, accelerates smoothly, slows for turns, sways and
/// rolls over bumps; its heading follows the path. The truth is a quintic B-spline, so every derivative is
/// exact. Immutable, thread-safe.
class Trajectory {
 public:
  /// kInvalidArgument for a bad path, kInvalidConfig for values out of range.
  static Result<Trajectory> create(const World::Path& path, const TrajectoryConfig& config);

  /// Time since the start of the simulation, held inside [0, duration_s].
  [[nodiscard]] BodyState at(double time_s) const;
  [[nodiscard]] geometry::RigidTransform world_from_body(double time_s) const;

 private:
  explicit Trajectory(BodySpline spline) : spline_(std::move(spline)) {}
  BodySpline spline_;
};

}  // namespace edgesplat::simulate
