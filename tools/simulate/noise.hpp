// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace edgesplat::simulate {

/// Hash of one integer (the finaliser of SplitMix64, Steele 2014): every bit of the input moves every bit
/// out.
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31U);
}

/// What a noise stream belongs to, so that no two parts of a device draw the same numbers.
enum class NoisePurpose : std::uint64_t {
  kImuWhite = 1,
  kImuBias,
  kLidarShot,
  kLidarClock,
  kCameraClock,
  kArrival,
  kBodyMotion,
  kStreamFault,
  kPlace,
  kCrowd,
  kCameraPixel,
};

/// A reproducible stream of random numbers: a pure function of (seed, purpose, index), so that work may be
/// split over threads in any way. std distributions are not used since their results differ between standard
/// libraries. Single-owner, as small as a counter: make one for every ray.
class NoiseStream {
 public:
  NoiseStream(std::uint64_t seed, NoisePurpose purpose, std::uint64_t index)
      : state_(mix_bits(mix_bits(seed + mix_bits(static_cast<std::uint64_t>(purpose))) ^ index)) {}

  std::uint64_t bits() { return mix_bits(state_++); }
  /// In [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11U) * 0x1.0p-53; }
  /// Mean 0, deviation 1: Box-Muller, the second value of the pair is dropped.
  double gaussian() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }
  Eigen::Vector3d gaussian3() {
    const double x = gaussian(), y = gaussian(), z = gaussian();
    return {x, y, z};
  }
  /// Mean 1.
  double exponential() { return -std::log(1.0 - uniform()); }

 private:
  std::uint64_t state_;
};

}  // namespace edgesplat::simulate
