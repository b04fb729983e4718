// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/camera_sensor.hpp"

#include "tools/simulate/noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace edgesplat::simulate {
namespace {

constexpr std::size_t kCodes =
    8192;  ///< steps of the linear value: one is less than one sRGB step in the dark

std::array<std::uint8_t, kCodes> make_srgb_table() {
  std::array<std::uint8_t, kCodes> table{};
  for (std::size_t i = 0; i < kCodes; ++i) {
    const double v = static_cast<double>(i) / (kCodes - 1);
    const double s = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
    table[i] = static_cast<std::uint8_t>(std::lround(255.0 * s));
  }
  return table;
}

std::uint8_t to_srgb(float linear) {
  static const std::array<std::uint8_t, kCodes> kTable = make_srgb_table();
  // lround is a call, for every pixel. NOLINTNEXTLINE(bugprone-incorrect-roundings)
  return kTable[static_cast<std::size_t>(std::clamp(linear, 0.0F, 1.0F) * (kCodes - 1) + 0.5F)];
}

/// Mean 0, deviation 1: the sum of four uniform numbers from one hash, near enough to normal for noise.
float cheap_normal(std::uint64_t bits) {
  const auto part = [bits](unsigned i) { return static_cast<float>(bits >> (16U * i) & 0xFFFFU); };
  constexpr float kMean = 2.0F * 65535.0F, kDeviation = 37837.0F;  // 65536 / sqrt(3)
  return (part(0) + part(1) + part(2) + part(3) - kMean) / kDeviation;
}

double factor_at(const std::vector<CameraSensorConfig::ExposureStep>& steps, double time_s) {
  double factor = 1.0;
  for (const auto& step : steps)
    if (step.from_s <= time_s) factor = step.factor;
  return factor;
}

}  // namespace

double CameraSensor::exposure_s(double time_s) const {
  return config_.exposure_s * factor_at(config_.exposure_steps, time_s);
}

float CameraSensor::gain(double time_s) const {
  return static_cast<float>(exposure_s(time_s) / config_.exposure_s * factor_at(config_.light_steps, time_s));
}

sensor::ImageRgb8 CameraSensor::expose(const sensor::ImageRgbF32& radiance, std::uint64_t frame,
                                       double time_s) const {
  sensor::ImageRgb8 out(radiance.width_px, radiance.height_px);
  const float gain = this->gain(time_s);
  const auto well = static_cast<float>(config_.full_well_electrons);
  const auto read2 = static_cast<float>(config_.read_noise_electrons * config_.read_noise_electrons);
  const double cx = (radiance.width_px - 1) / 2.0, cy = (radiance.height_px - 1) / 2.0;
  const double corner2 = std::max(1.0, cx * cx + cy * cy);
  NoiseStream draw(config_.seed, NoisePurpose::kCameraPixel, frame);
  const std::uint64_t key = draw.bits();
  for (int y = 0; y < radiance.height_px; ++y) {
    for (int x = 0; x < radiance.width_px; ++x) {
      const double r2 = ((x - cx) * (x - cx) + (y - cy) * (y - cy)) / corner2;
      const float scale = gain * static_cast<float>(1.0 - config_.vignetting * r2);
      const float* in = radiance.pixel(x, y);
      std::uint8_t* pixel = out.pixel(x, y);
      for (std::size_t c = 0; c < 3; ++c) {
        const float electrons = std::min(1.0F, in[c] * scale) * well;
        const auto place = static_cast<std::uint64_t>(pixel - out.values.data()) + c;
        const float noise =
            cheap_normal(mix_bits(key + place)) * std::sqrt(std::max(0.0F, electrons) + read2);
        pixel[c] = to_srgb((electrons + noise) / well);
      }
    }
  }
  return out;
}

sensor::ImageRgb8 CameraSensor::expose_ideal(const sensor::ImageRgbF32& radiance, double time_s) const {
  sensor::ImageRgb8 out(radiance.width_px, radiance.height_px);
  const float gain = this->gain(time_s);
  std::transform(radiance.values.begin(), radiance.values.end(), out.values.begin(),
                 [gain](float v) { return to_srgb(v * gain); });
  return out;
}

}  // namespace edgesplat::simulate
