// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/lidar_returns.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace edgesplat::simulate {
namespace {

constexpr double kNearRange_m = 40.0, kNearReflectivity = 0.1;
constexpr double kFarRange_m = 70.0, kFarReflectivity = 0.8;
constexpr double kEdge_m = 0.3;     // a depth step that the beam can straddle ...
constexpr double kMaxGlue_m = 3.0;  // ... and one so large that the two echoes are told apart
constexpr double kShotSpacing_rad =
    0.015;                          // between shots of one line: one slanted surface steps by this much
constexpr double kFadeStart = 0.9;  // share of the detection range from which returns get lost
constexpr double kReflectivityUnits = 150.0;  // the protocol's 100 % diffuse

WirePoint quantise(const Eigen::Vector3d& p_in_lidar_m, double reflectivity, std::uint8_t tag) {
  const auto millimetres = [](double metres) {
    return static_cast<std::int32_t>(std::lround(1000.0 * metres));
  };
  const double units = std::clamp(kReflectivityUnits * reflectivity, 0.0, 255.0);
  return {millimetres(p_in_lidar_m.x()), millimetres(p_in_lidar_m.y()), millimetres(p_in_lidar_m.z()),
          static_cast<std::uint8_t>(std::lround(units)), tag};
}

Eigen::Vector3d tilt(const Eigen::Vector3d& direction, double sigma_rad, NoiseStream& noise) {
  const Eigen::Vector3d helper =
      std::abs(direction.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d side = direction.cross(helper).normalized();
  const double a = sigma_rad * noise.gaussian(), b = sigma_rad * noise.gaussian();
  return (direction + a * side + b * direction.cross(side)).normalized();
}

bool straddles_edge(const Shot& shot, double step_m) {
  const double slant_m =
      3.0 * shot.range_m * kShotSpacing_rad / std::max(0.02, static_cast<double>(shot.cosine));
  return std::abs(step_m) > std::max(kEdge_m, slant_m) && std::abs(step_m) < kMaxGlue_m;
}

// The device knows most of its glue points: two of three are marked bad, the rest medium or not at all.
std::uint8_t glue_tag(double draw) {
  if (draw < 0.65) return 2;
  return draw < 0.9 ? 1 : 0;
}

}  // namespace

double detection_range_m(double reflectivity) {
  static const double kExponent =
      std::log(kFarRange_m / kNearRange_m) / std::log(kFarReflectivity / kNearReflectivity);
  const double bounded = std::clamp(reflectivity, 0.0, kFarReflectivity);
  return kNearRange_m * std::pow(bounded / kNearReflectivity, kExponent);
}

double range_sigma_m(const LidarNoiseConfig& config, double range_m, double reflectivity) {
  const double echo = reflectivity / 0.5 * (100.0 / std::max(1e-6, range_m * range_m));
  return config.range_sigma_m * std::min(3.0, std::sqrt(0.5 + 0.5 / std::max(1e-3, echo)));
}

WirePoint measure(const Shot& shot, double neighbour_m, const LidarNoiseConfig& config, NoiseStream noise) {
  if (!(shot.range_m > config.blind_zone_m)) return {};
  const double brightness = static_cast<double>(shot.reflectivity) * static_cast<double>(shot.cosine);
  double range_m = shot.range_m;
  if (!config.noisy) return quantise(range_m * shot.direction, brightness, 0);

  const double share_of_reach = range_m / std::max(1e-3, detection_range_m(brightness));
  if (share_of_reach > kFadeStart + (1.0 - kFadeStart) * noise.uniform()) return {};
  std::uint8_t tag = 0;
  const double step_m = neighbour_m - range_m;
  if (neighbour_m > 0.0 && straddles_edge(shot, step_m) && noise.uniform() < config.glue_share) {
    range_m += step_m * noise.uniform();
    tag = glue_tag(noise.uniform());
  }
  range_m += range_sigma_m(config, range_m, brightness) * noise.gaussian();
  if (range_m <= config.blind_zone_m) return {};
  return quantise(range_m * tilt(shot.direction, config.bearing_sigma_rad, noise), brightness, tag);
}

}  // namespace edgesplat::simulate
