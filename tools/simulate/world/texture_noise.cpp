// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/texture_noise.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::simulate {
namespace {

std::int32_t to_cell(double x) {
  return static_cast<std::int32_t>(std::floor(std::clamp(x, -2e9, 2e9)));
}

float ease(double t) {
  return static_cast<float>(t * t * (3.0 - 2.0 * t));
}

}  // namespace

std::uint32_t cell_hash(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  // Rounds of multiply and xor-shift after Wellons' triple32 (public domain), a low-bias 32-bit hash.
  std::uint32_t h = seed ^ (static_cast<std::uint32_t>(x) * 0x9E3779B1U);
  h = (h ^ (h >> 17U)) * 0xED5AD4BBU;
  h ^= static_cast<std::uint32_t>(y) * 0x85EBCA77U;
  h = (h ^ (h >> 11U)) * 0xAC4C1B51U;
  h = (h ^ (h >> 15U)) * 0x31848BABU;
  return h ^ (h >> 14U);
}

float cell_value(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  return static_cast<float>(cell_hash(x, y, seed) >> 8U) * 0x1.0p-24F;
}

float value_noise(const Eigen::Vector2d& at, std::uint32_t seed) {
  const std::int32_t x = to_cell(at.x()), y = to_cell(at.y());
  const float tx = ease(at.x() - x), ty = ease(at.y() - y);
  const float bottom = std::lerp(cell_value(x, y, seed), cell_value(x + 1, y, seed), tx);
  const float top = std::lerp(cell_value(x, y + 1, seed), cell_value(x + 1, y + 1, seed), tx);
  return 2.0F * std::lerp(bottom, top, ty) - 1.0F;
}

float detail_weight(double wavelength, double footprint) {
  return static_cast<float>(std::clamp(wavelength / std::max(footprint, 1e-9) / 2.0 - 1.0, 0.0, 1.0));
}

float octave_noise(const Eigen::Vector2d& at_m, const Octaves& octaves, double footprint_m) {
  float sum = 0.0F;
  float amplitude = 1.0F - octaves.gain;
  std::uint32_t seed = octaves.seed;
  for (double size_m = octaves.largest_m; size_m >= octaves.smallest_m; size_m /= 2.0) {
    const float weight = detail_weight(size_m, footprint_m);
    if (weight <= 0.0F) break;  // smaller ones vanish too
    // The grids of the octaves are shifted against each other so that their corners do not add up.
    sum += weight * amplitude * value_noise(at_m / size_m + Eigen::Vector2d(0.37, 0.71), ++seed);
    amplitude *= octaves.gain;
  }
  return 1.6F * sum;
}

float box_coverage(double x, double lo, double hi, double footprint) {
  const double half = std::max(footprint, 1e-6) / 2.0;
  return static_cast<float>(
      std::clamp((std::min(hi, x + half) - std::max(lo, x - half)) / (2.0 * half), 0.0, 1.0));
}

float pulse_coverage(double x, double width, double footprint) {
  const double half = std::max(footprint, 1e-6) / 2.0;
  const auto integral = [width](double t) {
    const double whole = std::floor(t);
    return whole * width + std::min(t - whole, width);
  };
  return static_cast<float>((integral(x + half) - integral(x - half)) / (2.0 * half));
}

float disc_coverage(const Eigen::Vector2d& from_centre, double radius, double footprint) {
  return static_cast<float>(
      std::clamp((radius - from_centre.norm()) / std::max(footprint, 1e-6) + 0.5, 0.0, 1.0));
}

}  // namespace edgesplat::simulate
