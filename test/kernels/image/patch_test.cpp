// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/image/patch.hpp"

#include "kernels/image/corner.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::image {
namespace {

/// A plane of brightness: bilinear interpolation is exact on it.
double brightness(double x, double y) {
  return 20.0 + 1.0 * x + 2.0 * y;
}

sensor::ImageGray8 plane() {
  sensor::ImageGray8 picture(64, 48);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) *picture.pixel(x, y) = static_cast<std::uint8_t>(brightness(x, y));
  return picture;
}

TEST(SamplePatch, FollowsAnAffineStep) {
  const Eigen::Vector2f centre(30.3F, 20.8F);
  Eigen::Matrix2f step;
  step << 0.8F, 0.3F, -0.2F, 1.1F;
  PatchValues values;
  ASSERT_TRUE(sample_patch(plane(), {centre, step}, values));
  for (int row = 0; row < kPatchSide; ++row) {
    for (int column = 0; column < kPatchSide; ++column) {
      const Eigen::Vector2f at =
          centre + step * Eigen::Vector2f(static_cast<float>(column) - 3.5F, static_cast<float>(row) - 3.5F);
      EXPECT_NEAR(values[static_cast<std::size_t>(row * kPatchSide + column)],
                  brightness(static_cast<double>(at.x()), static_cast<double>(at.y())), 1e-3);
    }
  }
}

/// A wall beside the way, seen by a pinhole camera of 100 pixels' focal length from z = 0 and from z = 0.8 m.
TEST(SamplePatch, FollowsAWallThatAnotherCameraSees) {
  constexpr float kFocal_px = 100.0F, kForward_m = 0.8F, kX_px = 30.0F, kY_px = 12.0F;  // from the axis
  constexpr float kBeside_m = 0.6F;
  const auto depth_m = [](float x_px) { return kFocal_px * kBeside_m / x_px; };
  // A pixel of the first camera in the second one, from the axis.
  const auto moved = [&](float x_px, float y_px) {
    const float z = depth_m(x_px);
    return Eigen::Vector2f(Eigen::Vector2f(x_px, y_px) * z / (z - kForward_m));
  };
  const float z = depth_m(kX_px);
  PatchWarp warp;
  const Eigen::Vector2f axis(-15.0F, 4.0F);
  warp.centre_px = axis + moved(kX_px, kY_px);
  constexpr float kStep = 0.01F;
  warp.step.col(0) = (moved(kX_px + kStep, kY_px) - moved(kX_px - kStep, kY_px)) / (2.0F * kStep);
  warp.step.col(1) = (moved(kX_px, kY_px + kStep) - moved(kX_px, kY_px - kStep)) / (2.0F * kStep);
  // The depth shrinks by a share 1 / x for a pixel to the right in the first picture; the same length off a
  // shorter depth in the second.
  warp.growth.x() = -(z / kX_px) / (z - kForward_m) + 1.0F / kX_px;
  PatchValues values;
  ASSERT_TRUE(sample_patch(plane(), warp, values));
  double affine_off = 0.0;
  for (int row = 0; row < kPatchSide; ++row) {
    for (int column = 0; column < kPatchSide; ++column) {
      const Eigen::Vector2f offset(static_cast<float>(column) - 3.5F, static_cast<float>(row) - 3.5F);
      const Eigen::Vector2f at = axis + moved(kX_px + offset.x(), kY_px + offset.y());
      EXPECT_NEAR(values[static_cast<std::size_t>(row * kPatchSide + column)],
                  brightness(static_cast<double>(at.x()), static_cast<double>(at.y())), 0.02);
      affine_off += static_cast<double>((at - warp.centre_px - warp.step * offset).x()) / kPatchPixels;
    }
  }
  EXPECT_GT(affine_off, 0.1) << "an affine warp leaves out what would be taken for motion";
}

TEST(SamplePatch, RefusesToLeaveThePicture) {
  PatchValues values;
  const Eigen::Matrix2f unit = Eigen::Matrix2f::Identity();
  EXPECT_TRUE(sample_patch(plane(), {{3.5F, 3.5F}}, values));
  EXPECT_FALSE(sample_patch(plane(), {{3.4F, 20.0F}}, values));
  EXPECT_FALSE(sample_patch(plane(), {{59.6F, 20.0F}}, values));
  EXPECT_FALSE(sample_patch(plane(), {{30.0F, 20.0F}, 6.0F * unit}, values));
  EXPECT_FALSE(sample_patch(plane(), {{std::nanf(""), 20.0F}}, values));
  EXPECT_TRUE(sample_patch(plane(), {{30.0F, 20.0F}, unit, {0.05F, 0.05F}}, values));
  EXPECT_FALSE(sample_patch(plane(), {{30.0F, 20.0F}, unit, {0.1F, 0.05F}}, values));
}

TEST(CutPatch, HoldsThePixelsAndTheirSlopes) {
  const auto patch = cut_patch(plane(), {20.5F, 16.5F});
  ASSERT_TRUE(patch.has_value());
  EXPECT_EQ((*patch)[0], static_cast<std::uint8_t>(brightness(16, 12)));
  const PatchTemplate made = make_template(*patch);
  for (std::size_t i = 0; i < made.value.size(); ++i) {
    EXPECT_EQ(made.dx[i], 1.0F);
    EXPECT_EQ(made.dy[i], 2.0F);
  }
  EXPECT_FALSE(cut_patch(plane(), {4.4F, 16.5F}).has_value());
}

TEST(StrongestCorner, PrefersTheCornerOfASquareToItsSides) {
  sensor::ImageGray8 picture(64, 64, 50);
  for (int y = 28; y < 60; ++y)
    for (int x = 28; x < 60; ++x) *picture.pixel(x, y) = 150;
  const auto corner = strongest_corner(picture, {2, 2, 50, 50});
  ASSERT_TRUE(corner.has_value());
  EXPECT_LT((corner->centre_px - Eigen::Vector2f(27.5F, 27.5F)).norm(), 3.0F);
  // Where patches of three levels fall on whole pixels.
  EXPECT_EQ(std::fmod(corner->centre_px.x() + 0.5F, 4.0F), 0.0F);
  const auto side = strongest_corner(picture, {36, 16, 52, 40});
  ASSERT_TRUE(side.has_value());
  EXPECT_GT(corner->score, 3.0F * side->score);
  EXPECT_GT(side->score, 0.0F);
}

TEST(StrongestCorner, NeedsRoomForAWindow) {
  const sensor::ImageGray8 picture(64, 64, 50);
  EXPECT_FALSE(strongest_corner(picture, {0, 0, 8, 8}).has_value());
  EXPECT_TRUE(strongest_corner(picture, {0, 0, 12, 12}).has_value());
  EXPECT_FALSE(strongest_corner(picture, {60, 60, 90, 90}).has_value());
}

}  // namespace
}  // namespace edgesplat::image
