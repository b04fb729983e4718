// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace edgesplat::simulate {

/// Building blocks of the procedural textures. Every one is filtered: `footprint` is the width of the box
/// over which the texture is averaged, in the same unit as the coordinates, so that pictures do not alias.

/// Hash of a grid cell, the same on every machine.
[[nodiscard]] std::uint32_t cell_hash(std::int32_t x, std::int32_t y, std::uint32_t seed);
/// The same as a number in [0, 1).
[[nodiscard]] float cell_value(std::int32_t x, std::int32_t y, std::uint32_t seed);

/// Smooth noise in [-1, 1] on a unit grid, unfiltered.
[[nodiscard]] float value_noise(const Eigen::Vector2d& at, std::uint32_t seed);

struct Octaves {
  double largest_m = 1.0;
  double smallest_m = 0.005;
  float gain = 0.6F;  ///< amplitude of an octave relative to the one twice as large
  std::uint32_t seed = 0;
};
/// Sum of octaves in about [-1, 1]; an octave fades out as its wavelength nears two footprints.
[[nodiscard]] float octave_noise(const Eigen::Vector2d& at_m, const Octaves& octaves, double footprint_m);

/// Share of the footprint around x that lies in [lo, hi].
[[nodiscard]] float box_coverage(double x, double lo, double hi, double footprint);
/// Share of the footprint around x that lies in the pulses [n, n + width) for all whole n.
[[nodiscard]] float pulse_coverage(double x, double width, double footprint);
/// Share inside a circle, about.
[[nodiscard]] float disc_coverage(const Eigen::Vector2d& from_centre, double radius, double footprint);
/// 1 for details much larger than the footprint, 0 for those that it averages away.
[[nodiscard]] float detail_weight(double wavelength, double footprint);

}  // namespace edgesplat::simulate
