// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/view.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace edgesplat::mapping {

/// A picture that the map should reproduce. The arrays belong to the caller and must outlive the step.
struct TrainingView {
  splat::View view;
  std::span<const float> colour;   ///< [H,W,3] sRGB, 0..1
  std::span<const float> depth_m;  ///< [H,W] along z, 0: not measured; empty: no depth
  std::span<const float> weight;   ///< [H,W] 0..1, 0 where something moves; empty: every pixel counts
  /// Pictures of one key share a learned gain and offset a channel, since cameras change their exposure.
  /// Usually the keyframe's number. Without: the picture is taken as it is.
  std::optional<std::uint32_t> exposure_key;

  [[nodiscard]] bool consistent() const {
    if (view.width_px <= 0 || view.height_px <= 0) return false;
    const auto pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
    return colour.size() == 3 * pixels && (depth_m.empty() || depth_m.size() == pixels) &&
           (weight.empty() || weight.size() == pixels);
  }
};

}  // namespace edgesplat::mapping
