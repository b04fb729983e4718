// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/rig.hpp"
#include "common/time/time.hpp"
#include "robot/sync/measure_group.hpp"
#include "robot/tracking/filter_state.hpp"

#include <span>
#include <vector>

namespace edgesplat::tracking {

/// Rotation rate and specific force that hold for a short while, with the noise they carry.
struct MotionInput {
  Eigen::Vector3d gyro_radps;
  Eigen::Vector3d accel_mps2;
};

/// Continuous-time noise densities: the covariance grows by density squared times time.
struct MotionNoise {
  double rotation_radps_per_sqrt_hz = 0.0;
  double velocity_mps2_per_sqrt_hz = 0.0;
  double gyro_bias_radps2_per_sqrt_hz = 0.0;
  double accel_bias_mps3_per_sqrt_hz = 0.0;
};

[[nodiscard]] MotionNoise imu_noise(const sensor::ImuModel& model);

/// One step by `dt_s` with the specific force turned by half the step's rotation.
[[nodiscard]] FilterState integrate(const FilterState& state, const MotionInput& input, double dt_s);
/// d(error after) / d(error before) of integrate().
[[nodiscard]] ErrorMatrix transition(const FilterState& state, const MotionInput& input, double dt_s);
/// State and covariance by one step.
void propagate(FilterBelief& belief, const MotionInput& input, const MotionNoise& noise, double dt_s);

/// Where the body was at a moment on the way.
struct PathKnot {
  HostTime stamp{};
  geometry::RigidTransform odom_from_body;
};

/// A belief carried forward, with the way there for deskewing.
struct Prediction {
  FilterBelief belief;
  std::vector<PathKnot> path;  ///< oldest first, from the start to the end
  bool imu_covers = true;      ///< false: a part was bridged without IMU
};

struct Interval {
  HostTime begin{};
  HostTime end{};
};

/// Carries a belief through the IMU samples (ascending stamps, at least one) over `interval`: mean of two
/// samples, clipped to the interval. At the ends the nearest sample holds for three periods; beyond, and in
/// holes longer than that, the motion is taken as uniform with the noise of `free_motion`.
[[nodiscard]] Prediction predict_with_imu(const FilterBelief& belief, std::span<const sync::GroupImu> imu,
                                          const sensor::ImuModel& model, const MotionNoise& free_motion,
                                          Interval interval);

/// Constant velocity without any IMU. The gyro bias holds minus the rotation rate, so that the same equations
/// and the same covariance serve (a gyro that always reads zero); its walk and the velocity's are the noise.
[[nodiscard]] Prediction predict_without_imu(const FilterBelief& belief, const MotionNoise& free_motion,
                                             Interval interval);

/// The way at constant velocity through a state of predict_without_imu, before and after its moment `at`.
[[nodiscard]] std::vector<PathKnot> uniform_path(const FilterState& state, HostTime at, Interval interval);
/// What a path to or through `predicted` (at the moment `at`) becomes when that state was in truth
/// `corrected`: moved along, and bent by the change of velocity and gyro bias.
void correct_path(std::vector<PathKnot>& path, HostTime at, const FilterState& predicted,
                  const FilterState& corrected);

}  // namespace edgesplat::tracking
