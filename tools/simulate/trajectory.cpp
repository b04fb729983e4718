// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/trajectory.hpp"

#include "tools/simulate/noise.hpp"
#include "tools/simulate/route.hpp"
#include "tools/simulate/speed_profile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace edgesplat::simulate {
namespace {

constexpr double kKnot_s = 0.05;

// A sine with a random phase: one mode in which the body swings while it drives.
struct Swing {
  double amplitude;
  double frequency_hz;
  double phase_rad;
  [[nodiscard]] double at(double time_s) const {
    return amplitude * std::sin(2.0 * std::numbers::pi * frequency_hz * time_s + phase_rad);
  }
};

// Sway of the suspension and bumps of the floor; all of it vanishes at rest.
class BodyMotion {
 public:
  explicit BodyMotion(std::uint64_t seed) : seed_(seed) {
    NoiseStream noise(seed, NoisePurpose::kBodyMotion, 0);
    const auto swing = [&noise](double amplitude, double frequency_hz) {
      return Swing{amplitude, frequency_hz, 2.0 * std::numbers::pi * noise.uniform()};
    };
    sway_m_ = swing(0.008, 0.7);
    heave_m_ = swing(0.003, 2.3);
    pitch_rad_ = swing(0.005, 1.3);
    roll_rad_ = swing(0.007, 0.9);
    yaw_rad_ = swing(0.008, 0.55);
  }

  // Lateral, vertical offsets (m) and yaw, pitch, roll (rad), before the scale of speed.
  [[nodiscard]] Eigen::Matrix<double, 5, 1> at(double time_s, double distance_m) const {
    Eigen::Matrix<double, 5, 1> out;
    out << sway_m_.at(time_s), heave_m_.at(time_s), yaw_rad_.at(time_s), pitch_rad_.at(time_s),
        roll_rad_.at(time_s);
    const auto nearest = static_cast<std::int64_t>(std::floor(distance_m / kBumpSpacing_m));
    for (std::int64_t bump = nearest - 1; bump <= nearest + 1; ++bump) add_bump(bump, distance_m, out);
    return out;
  }

 private:
  static constexpr double kBumpSpacing_m = 2.0;

  void add_bump(std::int64_t bump, double distance_m, Eigen::Matrix<double, 5, 1>& out) const {
    NoiseStream noise(seed_, NoisePurpose::kBodyMotion, 1000 + static_cast<std::uint64_t>(bump + 1));
    const double centre_m = (static_cast<double>(bump) + noise.uniform()) * kBumpSpacing_m;
    const double height_m = 0.006 * noise.uniform();
    const double roll_rad = 0.012 * (noise.uniform() - 0.5);
    const double x = (distance_m - centre_m) / 0.15;
    const double bell = std::exp(-0.5 * x * x);
    out[1] += height_m * bell;
    out[3] += 1.2 * height_m * x * bell;  // the nose goes up first: pitch < 0 before the crest
    out[4] += roll_rad * bell;
  }

  std::uint64_t seed_;
  Swing sway_m_{}, heave_m_{}, yaw_rad_{}, pitch_rad_{}, roll_rad_{};
};

/// Rate of turning on itself, as a share: some way round to the left, a short rest, as far to the right.
double spin_share(double time_s) {
  constexpr double kRamp_s = 0.6, kTurning_s = 4.0, kRest_s = 0.6, kHalf_s = kTurning_s + kRest_s;
  if (time_s <= 0.0) return 0.0;
  const double in_period_s = std::fmod(time_s, 2.0 * kHalf_s);
  const double at_s = std::fmod(in_period_s, kHalf_s);
  const double edge = std::clamp(std::min(at_s, kTurning_s - at_s) / kRamp_s, 0.0, 1.0);
  const double smooth = 0.5 - 0.5 * std::cos(std::numbers::pi * edge);
  return in_period_s < kHalf_s ? smooth : -smooth;
}

Status check_config(const TrajectoryConfig& config) {
  const bool good = config.duration_s > 0.0 && config.duration_s <= 36000.0 && config.standstill_s >= 0.0 &&
                    config.acceleration_mps2 > 0.0 && config.turn_rate_limit_radps > 0.0 &&
                    config.body_motion >= 0.0 && config.body_motion <= 10.0 && config.spin_radps >= 0.0 &&
                    config.spin_radps <= 6.0;
  if (!good) return fail(Errc::kInvalidConfig, "trajectory: a duration, limit or scale is out of range");
  return {};
}

Eigen::Quaterniond rotation_of(double yaw, double pitch, double roll) {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
}

}  // namespace

Result<Trajectory> Trajectory::create(const World::Path& path, const TrajectoryConfig& config) {
  EDGESPLAT_TRY_STATUS(check_config(config));
  EDGESPLAT_TRY(const Route route, Route::create(path));
  const auto progress = drive(route, path.speed_mps, config, kKnot_s);
  const BodyMotion motion(config.seed);

  std::vector<BodyCoordinates> controls;
  controls.reserve(progress.size());
  double yaw = 0.0, spun = 0.0;
  for (std::size_t j = 0; j < progress.size(); ++j) {
    const double time_s = BodySpline::control_time_s(j, kKnot_s);
    const double gate = config.body_motion * std::min(1.0, progress[j].speed_mps / path.speed_mps);
    const Eigen::Matrix<double, 5, 1> swing = gate * motion.at(time_s, progress[j].distance_m);
    const Eigen::Vector3d ahead = route.direction(progress[j].distance_m);
    const double heading = std::atan2(ahead.y(), ahead.x());
    yaw = j == 0 ? heading : yaw + std::remainder(heading - yaw, 2.0 * std::numbers::pi);
    const Eigen::Vector3d left(-std::sin(yaw), std::cos(yaw), 0.0);
    BodyCoordinates control;
    control.head<3>() = route.position_m(progress[j].distance_m) + swing[0] * left;
    control[2] += swing[1];
    control[3] = yaw + swing[2] + spun;
    spun += config.spin_radps * spin_share(time_s + 0.5 * kKnot_s - config.standstill_s) * kKnot_s;
    control[4] = -std::asin(std::clamp(ahead.z(), -1.0, 1.0)) + swing[3];
    control[5] = swing[4];
    controls.push_back(control);
  }
  return Trajectory(BodySpline(std::move(controls), kKnot_s));
}

geometry::RigidTransform Trajectory::world_from_body(double time_s) const {
  const BodyCoordinates c = spline_.derivative(time_s, 0);
  return {rotation_of(c[3], c[4], c[5]), c.head<3>()};
}

BodyState Trajectory::at(double time_s) const {
  const BodyCoordinates c = spline_.derivative(time_s, 0);
  const BodyCoordinates rate = spline_.derivative(time_s, 1);
  BodyState state;
  state.world_from_body = {rotation_of(c[3], c[4], c[5]), c.head<3>()};
  state.velocity_mps = rate.head<3>();
  state.acceleration_mps2 = spline_.derivative(time_s, 2).head<3>();
  // Body rates of R = Rz(yaw) Ry(pitch) Rx(roll).
  const double sin_p = std::sin(c[4]), cos_p = std::cos(c[4]);
  const double sin_r = std::sin(c[5]), cos_r = std::cos(c[5]);
  state.angular_velocity_radps = {rate[5] - rate[3] * sin_p, rate[4] * cos_r + rate[3] * cos_p * sin_r,
                                  rate[3] * cos_p * cos_r - rate[4] * sin_r};
  return state;
}

}  // namespace edgesplat::simulate
