// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/image.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace edgesplat::simulate {

struct CameraSensorConfig {
  double exposure_s = 0.008;           ///< exposure for which radiance 1 just fits, > 0
  double vignetting = 0.25;            ///< light lost in the corners, 0..0.9
  double full_well_electrons = 12000;  ///< at value 1: sets the shot noise, > 0
  double read_noise_electrons = 8.0;   ///< 1 sigma, >= 0
  std::uint64_t seed = 1;
  /// The exposure changes by a factor from a time on, as an automatic one does between rooms; ascending
  /// times.
  struct ExposureStep {
    double from_s = 0.0;
    double factor = 1.0;
  };
  std::vector<ExposureStep> exposure_steps;
  std::vector<ExposureStep> light_steps;  ///< the same of the light, which the exposure told knows nothing of
};

/// Turns linear radiance into the picture that a camera delivers: exposure, vignetting, shot and read noise,
/// saturation, sRGB encoding. Immutable, thread-safe; a picture is a pure function of (radiance, frame,
/// time).
class CameraSensor {
 public:
  explicit CameraSensor(CameraSensorConfig config) : config_(std::move(config)) {}

  /// The frame with all faults of the sensor.
  [[nodiscard]] sensor::ImageRgb8 expose(const sensor::ImageRgbF32& radiance, std::uint64_t frame,
                                         double time_s) const;
  /// The truth: the same exposure, no vignetting, no noise.
  [[nodiscard]] sensor::ImageRgb8 expose_ideal(const sensor::ImageRgbF32& radiance, double time_s) const;
  [[nodiscard]] double exposure_s(double time_s) const;

 private:
  /// What a radiance becomes, as a factor.
  [[nodiscard]] float gain(double time_s) const;

  CameraSensorConfig config_;
};

}  // namespace edgesplat::simulate
