// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/block_loop.hpp"
#include "robot/tracking/calibration.hpp"
#include "robot/tracking/degeneracy.hpp"
#include "robot/tracking/filter_state.hpp"
#include "robot/tracking/plane_map.hpp"
#include "robot/tracking/point_noise.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::tracking {

struct ScanUpdateConfig {
  int max_iterations = 6;
  float gate_sigma = 3.0F;
  float min_residual_sigma_m = 0.01F;
  int min_residuals = 30;
};

/// The points to be matched, and how noisy they are.
struct ScanView {
  std::span<const Eigen::Vector3f> points_in_body_m;
  std::span<const Beam> beams;               ///< of the rig's LiDARs
  std::span<const std::uint8_t> units = {};  ///< the LiDAR of each point; empty: the first measured all

  /// Null where the calibration is held. Else `points_in_body_m` were made with that of the start.
  const CalibrationView* calibration = nullptr;

  /// Of the i-th point along a direction in the body frame.
  [[nodiscard]] float variance_along(std::size_t i, const Eigen::Vector3f& direction) const {
    const Beam& beam = beams[units.empty() ? 0U : units[i]];
    return beam.noise.variance_along(points_in_body_m[i] - beam.lidar_in_body_m, direction);
  }
};

/// A point and the plane it was found to lie on.
struct MatchedPoint {
  const Plane* plane = nullptr;  ///< nullptr: none
  std::uint32_t plane_id = 0;
  float residual_m = 0.0F;
  float point_variance_m2 = 0.0F;  ///< along the normal, with the model's
  float plane_variance_m2 = 0.0F;  ///< of the plane's place there: the same for all points nearby
  float spread_m2 = 0.0F;          ///< of the residual, the pose's doubt in it
  Eigen::Matrix<float, 6, 1> row;
};

/// The point-to-plane residuals at one pose.
struct PlaneResiduals {
  NormalEquations equations;
  int used = 0;             ///< residuals within the gate
  int matched = 0;          ///< points with a plane, within the gate or not
  double squares_m2 = 0.0;  ///< sum of r^2 of the used ones
};

struct ScanUpdateResult {
  FilterBelief belief;  ///< the posterior; the prior where `updated` is false
  bool updated = false;
  int iterations = 0;
  PlaneResiduals last;
  double translation_conditioning = 0.0;
  ObservedPart observed;  ///< of `last`
};

/// One residual and its row: r = n'(R p + t - q), dr/d(rot, pos) = [(p x R'n)', n'].
struct PointToPlane {
  double residual_m;
  Vector6d row;
};
[[nodiscard]] PointToPlane point_to_plane(const geometry::RigidTransform& odom_from_body,
                                          const Eigen::Vector3d& p_in_body_m, const Eigen::Vector3d& normal,
                                          const Eigen::Vector3d& centre_in_odom_m);

/// Smallest over largest eigenvalue of the translation's information with the rotation eliminated (Schur
/// complement): 0 where a direction is not seen.
[[nodiscard]] double translation_conditioning(const Matrix6d& information);

/// The iterated update of the error-state filter (FAST-LIO2, eq. 17-20) with the residuals of one scan. Keeps
/// its buffers; thread-bound.
class ScanUpdater {
 public:
  ScanUpdater(const ScanUpdateConfig& config, BlockLoop& loop) : config_(config), loop_(loop) {}

  /// Begins iterating at `start` (the prior's state, or a better guess of it).
  ScanUpdateResult run(const FilterBelief& prior, const FilterState& start, const ScanView& scan,
                       const PlaneMap& map);
  /// Residuals at one pose; `pose_covariance` widens the gate by what the pose may be off.
  PlaneResiduals evaluate(const geometry::RigidTransform& odom_from_body, const Matrix6d& pose_covariance,
                          const ScanView& scan, const PlaneMap& map);

 private:
  template <int Errors>
  ScanUpdateResult run_with(const FilterBelief& prior, const FilterState& start, const ScanView& scan,
                            const PlaneMap& map);
  void count_sharers(const PlaneMap& map);

  ScanUpdateConfig config_;
  BlockLoop& loop_;
  std::vector<PlaneResiduals> partial_;
  std::vector<MatchedPoint> matched_;
  std::vector<std::uint32_t> sharers_;  ///< by plane: how many of the scan's points lie on it
};

}  // namespace edgesplat::tracking
