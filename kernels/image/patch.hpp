// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/image.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>

namespace edgesplat::image {

/// Patches have 8 x 8 pixels at offsets -3.5, -2.5 .. 3.5 from their centre, row by row.
inline constexpr int kPatchSide = 8;
inline constexpr int kPatchPixels = kPatchSide * kPatchSide;
/// With one more pixel on each side, for derivatives.
inline constexpr int kBorderedSide = kPatchSide + 2;
using BorderedPatch = std::array<std::uint8_t, std::size_t{kBorderedSide} * kBorderedSide>;
using PatchValues = std::array<float, kPatchPixels>;

/// The bordered patch around `centre_px`; between pixels bilinear. Nothing where it would leave the picture.
[[nodiscard]] std::optional<BorderedPatch> cut_patch(const sensor::ImageGray8& picture,
                                                     const Eigen::Vector2f& centre_px);

/// Values at centre + step * offset, bilinear: the patch as a picture taken from elsewhere shows it. False,
/// with `values` untouched, where it would leave the picture.
[[nodiscard]] bool sample_patch(const sensor::ImageGray8& picture, const Eigen::Vector2f& centre_px,
                                const Eigen::Matrix2f& step, PatchValues& values);

/// A reference patch made ready for alignment.
struct PatchTemplate {
  PatchValues value;
  PatchValues dx;  ///< central differences, a patch pixel
  PatchValues dy;
};
[[nodiscard]] PatchTemplate make_template(const BorderedPatch& patch);

}  // namespace edgesplat::image
