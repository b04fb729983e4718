// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/image/patch.hpp"

#include <Eigen/Core>

namespace edgesplat::tracking {

using Matrix7d = Eigen::Matrix<double, 7, 7>;
using Vector7d = Eigen::Matrix<double, 7, 1>;

/// Noise of one patch against another, in grey levels of 255.
struct PatchNoise {
  float pixel = 2.5F;   ///< of each pixel, independent
  float offset = 6.0F;  ///< common to the patch: vignetting, shadows, what a single gain does not explain
  /// Of the patch's contrast, as a share. Noise, focus and sampling lower it, and a gain that had to explain
  /// that would creep from reference to reference.
  float contrast = 0.15F;
};

/// sRGB values plus this are a power of the light (exponent 1/2.4): then a longer exposure is a factor.
inline constexpr float kToeGrey = 14.0F;

/// Where a patch is in the present picture, and how that depends on the pose.
struct PatchView {
  image::PatchWarp warp;                     ///< in the pyramid level that is sampled
  Eigen::Matrix<float, 2, 6> pixel_by_pose;  ///< d centre / d (rotation, position)
  Eigen::Vector2f pixel_by_doubt;            ///< d centre / d (one sigma of the point's place)
  float gain = 1.0F;                         ///< present picture over reference
};

/// What one patch says about (rotation, position, log gain), for a unit of pixel noise.
struct PatchEquations {
  Matrix7d information = Matrix7d::Zero();
  Vector7d gradient = Vector7d::Zero();
  float chi_squared = 0.0F;  ///< of its 64 pixels, the offset and the doubt taken out
};

/// A reference patch ready to be compared: the inverse-compositional way, derivatives are the reference's and
/// computed once. Immutable.
class PatchResidual {
 public:
  PatchResidual(const image::BorderedPatch& reference, const PatchNoise& noise);

  /// Residuals I(warp(o)) + toe - gain (T(o) + toe) with the linearisation. The patch's offset and
  /// the point's doubt along its first ray are unknowns of their own, each with a prior, and eliminated: a
  /// wrong depth then costs no more than what it could move. False where the patch leaves the picture.
  [[nodiscard]] bool evaluate(const sensor::ImageGray8& picture, const PatchView& view,
                              PatchEquations& equations) const;
  /// How much there is to hold on to: mean squared gradient, grey levels a pixel.
  [[nodiscard]] float texture() const { return (moments_(0, 0) + moments_(1, 1)) / image::kPatchPixels; }

 private:
  PatchNoise noise_;
  image::PatchTemplate template_;
  Eigen::Matrix4f moments_;  ///< of the functions dx, dy, value + toe, 1
};

}  // namespace edgesplat::tracking
