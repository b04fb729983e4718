// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/rig.hpp"
#include "robot/sync/measure_group.hpp"
#include "robot/tracking/filter_state.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::tracking {

/// Where scans alone say that the body was, in a frame of their own: any attitude, metric.
struct ScanPose {
  HostTime stamp{};
  geometry::RigidTransform local_from_body;
  Eigen::Matrix<double, 6, 6> covariance;  ///< rotation (on the right), position
};

/// 1 sigma of what is known before.
struct AlignmentPriors {
  double gyro_bias_radps = 0.05;
  double accel_bias_mps2 = 0.1;
  double speed_mps = 2.0;  ///< of the first and the last pose: bounds what scans do not see
};

enum class AlignmentVerdict : std::uint8_t {
  kAligned,
  kTooFewPoses,
  kImuGap,        ///< the samples do not cover the way from the first pose to the last
  kResidual,      ///< poses and samples contradict each other
  kGravityNorm,   ///< what is left of the force is not the Earth's
  kUnobservable,  ///< gravity's direction or the gyro's bias stay too uncertain
};

struct InertialAlignment {
  AlignmentVerdict verdict = AlignmentVerdict::kTooFewPoses;
  FilterBelief belief;              ///< at the last pose, in the poses' frame: gravity points anywhere
  std::vector<FilterState> states;  ///< one a pose
  double chi_squared_per_dof = 0.0;
  double gravity_mps2 = 0.0;  ///< its length, before it is held to be the Earth's
  double gravity_sigma_mps2 = 0.0;
  double tilt_sigma_rad = 0.0;  ///< of gravity's direction, the worse of the two
};

/// Finds biases, gravity and velocities from metric poses and the IMU's samples between them: the batch
/// estimate over all poses (errors of rotation, position and velocity at each, and both biases and gravity)
/// with the samples preintegrated, by Gauss-Newton. Without motion the accelerometer's bias and gravity
/// cannot be told apart: the prior decides, and the covariance says so. Sources: Forster et al. 2017
/// (preintegration), Qin et al. 2018, V-B (alignment; there without scale). Needs at least four poses with
/// ascending stamps; cost O(poses^3 + samples).
[[nodiscard]] InertialAlignment align_inertial(std::span<const ScanPose> poses,
                                               std::span<const sync::GroupImu> imu,
                                               const sensor::ImuModel& model, const AlignmentPriors& priors);

/// A measurement that gravity has the Earth's length, of a belief in any frame.
void hold_gravity_norm(FilterBelief& belief);
/// The belief seen from a frame with z up and its origin at the body, whose x points ahead as far as it can.
[[nodiscard]] FilterBelief levelled(const FilterBelief& belief, geometry::RigidTransform& odom_from_local);

}  // namespace edgesplat::tracking
