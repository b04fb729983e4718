// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"

#include <cstddef>
#include <span>

namespace edgesplat::splat {

/// The parameters of N Gaussians that somebody else owns, as in gaussian::GaussianCloud.
struct GaussianSpans {
  std::span<const float> means_m;         ///< [N,3] in map
  std::span<const float> log_scales;      ///< [N,3] natural log of metres
  std::span<const float> quats_xyzw;      ///< [N,4] any length > 0; normalised inside
  std::span<const float> opacity_logits;  ///< [N]
  std::span<const float> sh;              ///< [N,(sh_degree+1)^2,3]
  int sh_degree = 0;                      ///< 0..3

  [[nodiscard]] std::size_t size() const { return opacity_logits.size(); }
  [[nodiscard]] std::size_t sh_floats_each() const {
    return static_cast<std::size_t>((sh_degree + 1) * (sh_degree + 1) * 3);
  }
  /// Every span has the length that N and sh_degree ask for.
  [[nodiscard]] bool consistent() const {
    const std::size_t n = size();
    return sh_degree >= 0 && sh_degree <= 3 && means_m.size() == 3 * n && log_scales.size() == 3 * n &&
           quats_xyzw.size() == 4 * n && sh.size() == sh_floats_each() * n;
  }
};

[[nodiscard]] inline GaussianSpans spans_of(const gaussian::GaussianCloud& cloud) {
  return {cloud.means_m, cloud.log_scales, cloud.quats_xyzw, cloud.opacity_logits, cloud.sh, cloud.sh_degree};
}

}  // namespace edgesplat::splat
