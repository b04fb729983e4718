// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/patch_residual.hpp"

#include <Eigen/LU>

#include <cmath>
#include <cstddef>

namespace edgesplat::tracking {

PatchResidual::PatchResidual(const image::BorderedPatch& reference, const PatchNoise& noise)
    : noise_(noise), template_(image::make_template(reference)) {
  moments_.setZero();
  for (float& value : template_.value) value += kToeGrey;
  for (std::size_t i = 0; i < template_.value.size(); ++i) {
    const Eigen::Vector4f functions(template_.dx[i], template_.dy[i], template_.value[i], 1.0F);
    moments_ += functions * functions.transpose();
  }
}

// All derivatives of a patch's residuals are sums of four functions over its pixels: f = (g dx, g dy, g
// value, 1), g the gain. With M = sum f f' and b = sum f r, a parameter with the coefficients c (4) has c' M
// c and c' b in the normal equations. The nuisances C (4x3, scaled to unit priors) are eliminated by Schur's
// complement:
//   M' = M - M C (1 + C' M C)^-1 C' M,  b' = b - M C (1 + C' M C)^-1 C' b.
bool PatchResidual::evaluate(const sensor::ImageGray8& picture, const PatchView& view,
                             PatchEquations& equations) const {
  image::PatchValues seen;
  if (!image::sample_patch(picture, view.centre_px, view.step, seen)) return false;
  float with_dx = 0.0F, with_dy = 0.0F, with_value = 0.0F, with_one = 0.0F, squares = 0.0F;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const float r = seen[i] + kToeGrey - view.gain * template_.value[i];
    with_dx += r * template_.dx[i];
    with_dy += r * template_.dy[i];
    with_value += r * template_.value[i];
    with_one += r;
    squares += r * r;
  }
  const Eigen::Vector4f scale(view.gain, view.gain, view.gain, 1.0F);
  const float weight = 1.0F / (noise_.pixel * noise_.pixel);
  const Eigen::Matrix4f m = weight * (scale * scale.transpose()).cwiseProduct(moments_);
  const Eigen::Vector4f b =
      weight * scale.cwiseProduct(Eigen::Vector4f(with_dx, with_dy, with_value, with_one));

  const Eigen::Matrix2f patch_by_pixel = view.step.inverse();
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
  equations.chi_squared = weight * squares - cb.dot(inner * cb);
  return true;
}

}  // namespace edgesplat::tracking
