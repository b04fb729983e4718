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

/// Where a patch's pixels lie in a picture taken from elsewhere: offset o at centre + step o / (1 +
/// growth'o). For a plane and pinhole cameras that is exact (a homography about the patch's centre).
struct PatchWarp {
  Eigen::Vector2f centre_px = Eigen::Vector2f::Zero();
  Eigen::Matrix2f step =
      Eigen::Matrix2f::Identity();  ///< pixels for a step of one patch pixel, at the centre
  /// By how much of itself the depth grows a patch pixel right and down, less the same in the patch's
  /// picture.
  Eigen::Vector2f growth = Eigen::Vector2f::Zero();
};

/// Values there, bilinear. False, with `values` untouched, where the patch would leave the picture, or its
/// depth change by half.
[[nodiscard]] bool sample_patch(const sensor::ImageGray8& picture, const PatchWarp& warp,
                                PatchValues& values);

/// A reference patch made ready for alignment.
struct PatchTemplate {
  PatchValues value;
  PatchValues dx;  ///< central differences, a patch pixel
  PatchValues dy;
};
[[nodiscard]] PatchTemplate make_template(const BorderedPatch& patch);

}  // namespace edgesplat::image
