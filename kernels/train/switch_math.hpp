// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/host_device.hpp"

#include <cmath>

namespace edgesplat::train {

/// A Gaussian's opacity behind a differentiable switch: o = sigmoid(base) * w with w = sigmoid(switch), both
/// parameters being learned. What is drawn is o, kept as its logit as everywhere else. Host and device;
/// templates, so that tests take double.

template <typename T>
EDGESPLAT_HOST_DEVICE inline T sigmoid(T logit) {
  return T(1) / (T(1) + std::exp(-logit));
}
template <typename T>
EDGESPLAT_HOST_DEVICE inline T logit_of(T share) {
  return std::log(share / (T(1) - share));
}

/// The logit of what is drawn.
template <typename T>
EDGESPLAT_HOST_DEVICE inline T switched_logit(T base_logit, T switch_logit) {
  return logit_of(sigmoid(base_logit) * sigmoid(switch_logit));
}

/// The base below a switch for which `drawn_logit` is drawn. No switch lets through more than its w: above
/// it, the base is as solid as a base gets.
template <typename T>
EDGESPLAT_HOST_DEVICE inline T base_logit(T drawn_logit, T switch_logit) {
  constexpr T kMost = T(0.99999);
  const T share = sigmoid(drawn_logit) / sigmoid(switch_logit);
  return logit_of(share < kMost ? share : kMost);
}

template <typename T>
struct BySwitched {
  T base, switched;  ///< dL by the base's logit and by the switch's
};

/// From dL by the logit of what is drawn, o: do/dbase = o (1 - b), do/dswitch = o (1 - w).
template <typename T>
EDGESPLAT_HOST_DEVICE inline BySwitched<T> switch_backward(T base, T switch_logit, T by_drawn_logit) {
  const T b = sigmoid(base), w = sigmoid(switch_logit);
  const T by_log_opacity = by_drawn_logit / (T(1) - b * w);  // dlogit(o) = do / (o (1 - o))
  return {by_log_opacity * (T(1) - b), by_log_opacity * (T(1) - w)};
}

/// dL of `factor` * w by the switch's logit: an L1 term on w, not on the logit, for which a switch of logit
/// 0, half open, would be the cheapest.
template <typename T>
EDGESPLAT_HOST_DEVICE inline T switch_cost_backward(T switch_logit, T factor) {
  const T w = sigmoid(switch_logit);
  return factor * w * (T(1) - w);
}

}  // namespace edgesplat::train
