// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

/// What the formats that keep a Gaussian in bytes have in common. Inside common/io only.
namespace edgesplat::io {

/// Rounded and cut to 0..255; 0 for NaN.
inline std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(std::isnan(value) ? 0.0F : std::round(value), 0.0F, 255.0F));
}

/// Opacity byte -> logit. The ends 0 and 255 stand for 0.001 and 0.999, since their logits are infinite.
inline float logit_of_byte(std::uint8_t opacity) {
  const float value = std::clamp(static_cast<float>(opacity) / 255.0F, 0.001F, 0.999F);
  return std::log(value / (1.0F - value));
}

inline std::uint8_t byte_of_logit(float logit) {
  return to_byte(255.0F / (1.0F + std::exp(-logit)));
}

/// kInvalidArgument where arrays have different lengths, a value is not finite or a rotation is zero.
[[nodiscard]] Status check_writable(const gaussian::GaussianCloud& cloud);

}  // namespace edgesplat::io
