// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace edgesplat::train {

/// dL by what the blend reads of one splat. conic[1] counts the off-diagonal element once (power has b dx
/// dy).
template <typename T>
struct SplatGradient {
  T u, v;      ///< per px
  T conic[3];  ///< xx, xy, yy
  T opacity;   ///< of the opacity itself, not of its logit
  T rgb[3];
  T depth;            ///< per m
  T log_opacity = 0;  ///< of the logarithm of the opacity as drawn; counts where it is antialiased
};

}  // namespace edgesplat::train
