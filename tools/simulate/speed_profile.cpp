// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/speed_profile.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::simulate {
namespace {

constexpr double kGrid_m = 0.1;
constexpr double kRamp_s = 0.8;  // from standstill the acceleration itself grows over this time

// Fastest speed at each grid distance from which the robot can still brake for all that follows.
std::vector<double> speed_limits(const Route& route, double speed_mps, const TrajectoryConfig& config) {
  const double reach_m = config.duration_s * speed_mps + 5.0;
  std::vector<double> limits(static_cast<std::size_t>(reach_m / kGrid_m) + 2, speed_mps);
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const double distance_m = static_cast<double>(i) * kGrid_m;
    const double curvature = std::abs(route.curvature(distance_m));
    if (curvature * speed_mps > config.turn_rate_limit_radps) {
      limits[i] = config.turn_rate_limit_radps / curvature;
    }
    if (!route.closed() && distance_m >= route.length_m()) limits[i] = 0.0;
  }
  for (std::size_t i = limits.size() - 1; i-- > 0;) {
    const double reachable =
        std::sqrt(limits[i + 1] * limits[i + 1] + 2.0 * config.acceleration_mps2 * kGrid_m);
    limits[i] = std::min(limits[i], reachable);
  }
  return limits;
}

double limit_at(const std::vector<double>& limits, double distance_m) {
  const double position =
      std::clamp(distance_m / kGrid_m, 0.0, static_cast<double>(limits.size() - 1) - 1e-9);
  const auto i = static_cast<std::size_t>(position);
  const double t = position - static_cast<double>(i);
  return (1.0 - t) * limits[i] + t * limits[i + 1];
}

}  // namespace

std::vector<Progress> drive(const Route& route, double speed_mps, const TrajectoryConfig& config,
                            double knot_s) {
  constexpr int kSubsteps = 10;
  const auto limits = speed_limits(route, speed_mps, config);
  std::vector<Progress> out(BodySpline::control_points_for(config.duration_s, knot_s));
  Progress now;
  for (std::size_t j = 0; j < out.size(); ++j) {
    out[j] = now;
    for (int k = 0; k < kSubsteps; ++k) {
      const double step_s = knot_s / kSubsteps;
      const double driving_s = BodySpline::control_time_s(j, knot_s) + k * step_s - config.standstill_s;
      if (driving_s < 0.0) continue;
      const double ramp = std::min(1.0, driving_s / kRamp_s);
      const double wish_mps = now.speed_mps + ramp * config.acceleration_mps2 * step_s;
      now.speed_mps = std::min(wish_mps, limit_at(limits, now.distance_m));
      now.distance_m += now.speed_mps * step_s;
    }
  }
  return out;
}

}  // namespace edgesplat::simulate
