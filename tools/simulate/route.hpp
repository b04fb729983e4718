// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "tools/simulate/world.hpp"

#include <Eigen/Core>

#include <vector>

namespace edgesplat::simulate {

/// A world's path by distance driven, its corners rounded. The rounding averages the polyline over
/// +-1.5 m, so the curve never leaves the polyline's hull. Immutable, thread-safe.
class Route {
 public:
  /// kInvalidArgument for fewer than two distinct waypoints, values that are not finite or no speed.
  static Result<Route> create(const World::Path& path);

  /// Before the start and behind the end of an open route: straight on. A closed route repeats.
  [[nodiscard]] Eigen::Vector3d position_m(double distance_m) const;
  /// Unit tangent.
  [[nodiscard]] Eigen::Vector3d direction(double distance_m) const;
  /// Turn of the heading per metre, rad/m, left positive.
  [[nodiscard]] double curvature(double distance_m) const;
  [[nodiscard]] double length_m() const { return distances_m_.back(); }
  [[nodiscard]] bool closed() const { return closed_; }

 private:
  Route() = default;
  [[nodiscard]] Eigen::Vector3d corner_position(double distance_m) const;
  std::vector<Eigen::Vector3d> corners_m_;  ///< a closed route ends with its first corner again
  std::vector<double> distances_m_;         ///< of the corners from the start
  bool closed_ = false;
};

}  // namespace edgesplat::simulate
