// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/patch_residual.hpp"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <cmath>

namespace edgesplat::tracking {
namespace {

/// Smooth spots, `gain` on the values plus the toe.
sensor::ImageGray8 spots(double gain = 1.0) {
  sensor::ImageGray8 picture(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const double value =
          110.0 + 40.0 * std::sin(0.35 * x) * std::cos(0.3 * y) + 20.0 * std::sin(0.2 * (x + y));
      *picture.pixel(x, y) = static_cast<std::uint8_t>(std::lround(gain * (value + 14.0) - 14.0));
    }
  }
  return picture;
}

/// The first two parameters of the pose move the patch by pixels right and down.
PatchView view_at(float x, float y) {
  PatchView view;
  view.warp.centre_px = {x, y};
  view.pixel_by_pose.setZero();
  view.pixel_by_pose(0, 0) = view.pixel_by_pose(1, 1) = 1.0F;
  view.pixel_by_doubt.setZero();
  return view;
}

PatchResidual reference(const PatchNoise& noise = {}) {
  return PatchResidual(*image::cut_patch(spots(), {31.5F, 31.5F}), noise);
}

TEST(PatchResidual, NothingIsLeftWhereThePatchIs) {
  PatchEquations equations;
  ASSERT_TRUE(reference().evaluate(spots(), view_at(31.5F, 31.5F), equations));
  EXPECT_LT(equations.chi_squared, 1e-3F);
  EXPECT_LT(equations.gradient.norm(), 1e-2);
  EXPECT_GT(equations.information(0, 0), 100.0);
  EXPECT_FALSE(reference().evaluate(spots(), view_at(2.0F, 31.5F), equations));
}

TEST(PatchResidual, StepsLeadBackFromAnOffset) {
  PatchView view = view_at(32.3F, 30.9F);
  PatchEquations equations;
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(reference().evaluate(spots(), view, equations));
    const Eigen::Vector2d step =
        equations.information.topLeftCorner<2, 2>().inverse() * -equations.gradient.head<2>();
    view.warp.centre_px += step.cast<float>();
  }
  EXPECT_NEAR(view.warp.centre_px.x(), 31.5F, 0.02F);
  EXPECT_NEAR(view.warp.centre_px.y(), 31.5F, 0.02F);
}

TEST(PatchResidual, GradientAgreesWithNumericDifferencesOfTheCost) {
  // Half of chi squared's derivative by the gain, which enters it in no other way.
  const PatchNoise noise{2.0F, 1e-3F, 1e-4F};
  PatchView view = view_at(31.9F, 31.2F);
  PatchEquations middle, more, less;
  constexpr float kStep = 1e-3F;
  ASSERT_TRUE(reference(noise).evaluate(spots(), view, middle));
  view.gain = std::exp(kStep);
  ASSERT_TRUE(reference(noise).evaluate(spots(), view, more));
  view.gain = std::exp(-kStep);
  ASSERT_TRUE(reference(noise).evaluate(spots(), view, less));
  const double numeric = 0.5 * static_cast<double>(more.chi_squared - less.chi_squared) / (2.0 * kStep);
  EXPECT_NEAR(middle.gradient(6) / numeric, 1.0, 0.05);
}

TEST(PatchResidual, ABrighterPictureIsAGainNotAShift) {
  PatchView view = view_at(31.5F, 31.5F);
  PatchEquations equations;
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(reference().evaluate(spots(1.2), view, equations));
    view.gain *= std::exp(static_cast<float>(-equations.gradient(6) / equations.information(6, 6)));
  }
  EXPECT_NEAR(view.gain, 1.2F, 0.02F);
  EXPECT_LT(equations.chi_squared, 5.0F);
}

TEST(PatchResidual, WhatADoubtfulDepthWouldMoveTellsNothing) {
  PatchView view = view_at(31.5F, 31.5F);
  PatchEquations sure, doubtful;
  ASSERT_TRUE(reference().evaluate(spots(), view, sure));
  view.pixel_by_doubt = {50.0F, 0.0F};
  ASSERT_TRUE(reference().evaluate(spots(), view, doubtful));
  EXPECT_LT(doubtful.information(0, 0), 0.001 * sure.information(0, 0));
  EXPECT_GT(doubtful.information(1, 1), 0.5 * sure.information(1, 1));
}

}  // namespace
}  // namespace edgesplat::tracking
