// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/route.hpp"
#include "tools/simulate/trajectory.hpp"

#include <vector>

namespace edgesplat::simulate {

struct Progress {
  double distance_m = 0.0;
  double speed_mps = 0.0;
};

/// How far the robot has driven at the times of a spline's control points: it stands, then speeds up with a
/// ramped acceleration, brakes before turns so that its turn rate stays below the limit, and stops at the end
/// of an open route.
[[nodiscard]] std::vector<Progress> drive(const Route& route, double speed_mps,
                                          const TrajectoryConfig& config, double knot_s);

}  // namespace edgesplat::simulate
