// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/livox_encoder.hpp"
#include "tools/simulate/noise.hpp"

#include <Eigen/Core>

namespace edgesplat::simulate {

/// How a ray becomes a return. Figures of the Mid-360's data sheet where it states them: 2 cm at 10 m, 0.15
/// degrees at most, 40 m at 10 % and 70 m at 80 % reflectivity, 0.1 m blind.
struct LidarNoiseConfig {
  double range_sigma_m = 0.02;        ///< at 10 m, 50 % reflectivity, perpendicular
  double bearing_sigma_rad = 0.0013;  ///< half of the sheet's bound, across the ray
  double blind_zone_m = 0.1;
  double glue_share = 0.15;  ///< of the shots at a depth edge: a point between the two surfaces
  bool noisy = true;         ///< false: exact points to the protocol's millimetre, every hit returns
};

/// One shot before noise.
struct Shot {
  Eigen::Vector3d direction;  ///< in the LiDAR's frame, unit
  float range_m = 0.0F;       ///< 0 = nothing hit
  float cosine = 0.0F;        ///< of the angle of incidence
  float reflectivity = 0.0F;  ///< of the surface
};

/// Greatest range at which a surface of this reflectivity (already times the cosine of incidence) returns:
/// the power law through the data sheet's two points, not above the second one.
[[nodiscard]] double detection_range_m(double reflectivity);
/// Deviation along the ray: grows with the square root of how weak the echo is, 0.7 to 3 x range_sigma_m.
[[nodiscard]] double range_sigma_m(const LidarNoiseConfig& config, double range_m, double reflectivity);
/// What the device reports for `shot`; zero point where there is no return. `neighbour_m`: range of the
/// same line's previous shot, 0 = none, to find depth edges.
[[nodiscard]] WirePoint measure(const Shot& shot, double neighbour_m, const LidarNoiseConfig& config,
                                NoiseStream noise);

}  // namespace edgesplat::simulate
