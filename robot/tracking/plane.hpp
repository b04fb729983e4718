// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/point_noise.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <optional>

namespace edgesplat::tracking {

/// Running sums of the points of one cell, relative to the cell's centre: all that a plane fit needs, in 88
/// bytes however many points there were.
struct PointSums {
  std::uint32_t count = 0;
  Eigen::Vector3f sum_m = Eigen::Vector3f::Zero();
  Symmetric3f squares_m2 = Symmetric3f::Zero();  ///< sum of p p'
  Symmetric3f noise_m2 = Symmetric3f::Zero();    ///< sum of the points' covariances
  Symmetric3f pose_m2 = Symmetric3f::Zero();     ///< sum of what the poses' errors add to them

  /// The pose's part is separate: it moves all points of a scan alike, so it neither turns the plane nor
  /// averages out.
  void add(const Eigen::Vector3f& p_from_centre_m, const Symmetric3f& covariance_m2,
           const Symmetric3f& pose_covariance_m2);
};

/// A plane with its uncertainty. A point p has the signed distance n'(p - centre).
struct Plane {
  Eigen::Vector3f normal;           ///< towards where it was seen from, once it is in a map
  Eigen::Vector3f seen_from;        ///< unit vector to the LiDAR that saw it, about the latest
  Eigen::Vector3f centre_m;         ///< mean of the points, relative to the cell's centre
  Symmetric3f normal_covariance;    ///< of the normal: zero along itself
  float offset_variance_m2 = 0.0F;  ///< of n' centre
  float excess_variance_m2 = 0.0F;  ///< scatter across the plane beyond what the points' noise explains
  float reach_m2 = 0.0F;            ///< variance of the points along the longer axis of the patch

  /// Variance of the plane's place below a point at d = p - centre (VoxelMap, eq. 8, with the plane's own
  /// roughness added).
  [[nodiscard]] float variance_at(const Eigen::Vector3f& d) const {
    const Symmetric3f& c = normal_covariance;
    const float turn = c(0) * d.x() * d.x() + c(3) * d.y() * d.y() + c(5) * d.z() * d.z() +
                       2.0F * (c(1) * d.x() * d.y() + c(2) * d.x() * d.z() + c(4) * d.y() * d.z());
    return turn + offset_variance_m2 + excess_variance_m2;
  }
};

enum class PlaneVerdict : std::uint8_t {
  kPlane,
  kUndecided,  ///< flat so far, but the points lie along a line: the normal is not known
  kNoPlane,
};

struct PlaneFit {
  PlaneVerdict verdict = PlaneVerdict::kNoPlane;
  Plane plane;  ///< valid with kPlane
};

/// Fits a plane to the sums. The covariance is first-order, with each point's noise replaced by the mean of
/// all: then it has a closed form in the sums (derivation in plane.cpp), so that no point needs to be kept.
[[nodiscard]] PlaneFit fit_plane(const PointSums& sums, float sigma_max_m);

}  // namespace edgesplat::tracking
