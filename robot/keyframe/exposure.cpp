// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/exposure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace edgesplat::keyframe {
namespace {

constexpr double kNoDifference = 0.005;  // a hundredth of a stop does not show in 8 bits

double linear_of(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

double srgb_of(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

std::array<std::uint8_t, 256> table_of(double gain) {
  std::array<std::uint8_t, 256> table{};
  for (std::size_t value = 0; value < table.size(); ++value) {
    const double light = std::min(1.0, gain * linear_of(static_cast<double>(value) / 255.0));
    table[value] = static_cast<std::uint8_t>(std::lround(255.0 * srgb_of(light)));
  }
  return table;
}

}  // namespace

sensor::ImageRgb8 ExposureEqualiser::equalise(const sensor::ImageRgb8& picture, float exposure_s) {
  if (!std::isfinite(exposure_s) || exposure_s <= 0.0F) return picture;
  if (reference_s_ <= 0.0F) reference_s_ = exposure_s;
  const double gain = static_cast<double>(reference_s_) / static_cast<double>(exposure_s);
  if (std::abs(gain - 1.0) < kNoDifference) return picture;
  const auto table = table_of(gain);
  sensor::ImageRgb8 equal = picture;
  for (std::uint8_t& value : equal.values) value = table[value];
  return equal;
}

}  // namespace edgesplat::keyframe
