// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/patch_residual.hpp"

#include <Eigen/LU>

namespace edgesplat::tracking {
namespace {

using Pixels = Eigen::Array<float, image::kPatchPixels, 1>;

/// A patch's pixels as one array: sums over it are taken in vectors, several pixels at a time.
Eigen::Map<const Pixels> pixels_of(const image::PatchValues& values) {
  return Eigen::Map<const Pixels>(values.data());
}

}  // namespace

PatchResidual::PatchResidual(const image::BorderedPatch& reference, const PatchNoise& noise)
    : noise_(noise), template_(image::make_template(reference)) {
  for (float& value : template_.value) value += kToeGrey;
  const auto dx = pixels_of(template_.dx), dy = pixels_of(template_.dy), value = pixels_of(template_.value);
  const float xx = (dx * dx).sum(), xy = (dx * dy).sum(), xv = (dx * value).sum(), x = dx.sum();
  const float yy = (dy * dy).sum(), yv = (dy * value).sum(), y = dy.sum();
  const float vv = (value * value).sum(), v = value.sum();
  moments_ << xx, xy, xv, x,  //
      xy, yy, yv, y,          //
      xv, yv, vv, v,          //
      x, y, v, static_cast<float>(image::kPatchPixels);
}

// All derivatives of a patch's residuals are sums of four functions over its pixels: f = (g dx, g dy, g
// value, 1), g the gain. With M = sum f f' and b = sum f r, a parameter with the coefficients c (4) has c' M
// c and c' b in the normal equations. The nuisances C (4x3, scaled to unit priors) are eliminated by Schur's
// complement:
//   M' = M - M C (1 + C' M C)^-1 C' M,  b' = b - M C (1 + C' M C)^-1 C' b.
bool PatchResidual::evaluate(const sensor::ImageGray8& picture, const PatchView& view,
                             PatchEquations& equations) const {
  image::PatchValues seen;
  if (!image::sample_patch(picture, view.warp, seen)) return false;
  const Pixels r = pixels_of(seen) + kToeGrey - view.gain * pixels_of(template_.value);
  const Eigen::Vector4f scale(view.gain, view.gain, view.gain, 1.0F);
  const float weight = 1.0F / (noise_.pixel * noise_.pixel);
  const Eigen::Matrix4f m = weight * (scale * scale.transpose()).cwiseProduct(moments_);
  const Eigen::Vector4f b =
      weight * scale.cwiseProduct(Eigen::Vector4f((r * pixels_of(template_.dx)).sum(),
                                                  (r * pixels_of(template_.dy)).sum(),
                                                  (r * pixels_of(template_.value)).sum(), r.sum()));

  const Eigen::Matrix2f patch_by_pixel = view.warp.step.inverse();
  Eigen::Matrix<float, 4, 3> nuisance = Eigen::Matrix<float, 4, 3>::Zero();
  nuisance(3, 0) = noise_.offset;
  nuisance.block<2, 1>(0, 1) = patch_by_pixel * view.pixel_by_doubt;
  nuisance(2, 2) = noise_.contrast;
  nuisance(3, 2) = -noise_.contrast * view.gain * moments_(2, 3) / moments_(3, 3);
  const Eigen::Matrix<float, 4, 3> mc = m * nuisance;
  const Eigen::Matrix3f inner = (Eigen::Matrix3f::Identity() + nuisance.transpose() * mc).inverse();
  const Eigen::Vector3f cb = nuisance.transpose() * b;
  const Eigen::Matrix4f reduced = m - mc * inner * mc.transpose();
  const Eigen::Vector4f reduced_b = b - mc * (inner * cb);

  Eigen::Matrix<float, 4, 7> parameters = Eigen::Matrix<float, 4, 7>::Zero();
  parameters.block<2, 6>(0, 0) = patch_by_pixel * view.pixel_by_pose;
  parameters(2, 6) = -1.0F;
  equations.information = (parameters.transpose() * reduced * parameters).cast<double>();
  equations.gradient = (parameters.transpose() * reduced_b).cast<double>();
  equations.chi_squared = weight * r.square().sum() - cb.dot(inner * cb);
  return true;
}

}  // namespace edgesplat::tracking
