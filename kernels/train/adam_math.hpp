// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/host_device.hpp"
#include "kernels/train/adam.hpp"

#include <cmath>

namespace edgesplat::train {

/// Adam of one parameter, for backends that give each a thread of its own. Host and device.

/// AdamOptions as kernels take them: logarithms once instead of powers a row.
struct AdamDecay {
  float beta1, beta2, epsilon;
  float log_beta1, log_beta2;
  float mean_final_share, mean_decay_steps;
};

inline AdamDecay adam_decay(const AdamOptions& options) {
  return {options.beta1,
          options.beta2,
          options.epsilon,
          static_cast<float>(std::log(static_cast<double>(options.beta1))),
          static_cast<float>(std::log(static_cast<double>(options.beta2))),
          options.mean_final_share,
          options.mean_decay_steps};
}

/// What depends on a row's count of steps.
struct AdamFactors {
  float first_correction;   ///< 1 / (1 - beta1^t)
  float second_correction;  ///< 1 / sqrt(1 - beta2^t)
  float mean_share;         ///< of the mean's rate
};

/// For the t-th step, t >= 1. expm1 instead of 1 - beta^t, which at the first steps is a difference of near
/// equals.
EDGESPLAT_HOST_DEVICE inline AdamFactors adam_factors(const AdamDecay& decay, unsigned step) {
  const auto t = static_cast<float>(step);
  return {-1.0F / std::expm1(t * decay.log_beta1), 1.0F / std::sqrt(-std::expm1(t * decay.log_beta2)),
          decay.mean_final_share +
              (1.0F - decay.mean_final_share) * std::exp(-(t - 1.0F) / decay.mean_decay_steps)};
}

/// The parameter after a step; moves its moments.
EDGESPLAT_HOST_DEVICE inline float adam_step(const AdamDecay& decay, const AdamFactors& factors, float rate,
                                             float g, float value, float& first, float& second) {
  first = decay.beta1 * first + (1.0F - decay.beta1) * g;
  second = decay.beta2 * second + (1.0F - decay.beta2) * g * g;
  const float root = std::sqrt(second) * factors.second_correction;
  return value - rate * (first * factors.first_correction) / (root + decay.epsilon);
}

}  // namespace edgesplat::train
