// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/project.hpp"

#include "kernels/splat/exp_fast.hpp"
#include "kernels/splat/sh_math.hpp"
#include "test/support/eigen_matchers.hpp"
#include "test/support/random_cloud.hpp"
#include "test/support/reference/splat_reference.hpp"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <cmath>
#include <map>
#include <numbers>

namespace edgesplat::splat {
namespace {

geometry::CameraModel camera() {
  return {geometry::CameraKind::kPinhole, 320, 240, 260.0, 255.0, 161.0, 118.5, {}};
}

/// Every backend that can run here; CUDA joins where it is compiled in and a device is there.
class ProjectOn : public testing::TestWithParam<core::Backend> {};

TEST_P(ProjectOn, AgreesWithTheReferenceAndIsSortedByDepth) {
  test::Random random(11);
  const auto cloud = test::random_cloud(random, {.count = 3000, .sh_degree = 3, .scale_max_m = 0.5});
  const geometry::RigidTransform pose{geometry::so3_exp(random.vector(0.4)), random.vector(1.0)};
  const auto projected = project(GetParam(), spans_of(cloud), *View::from(camera(), pose), {});
  ASSERT_TRUE(projected);
  std::map<std::size_t, test::ReferenceSplat> expected;
  for (const auto& splat : test::reference_splats(cloud, camera(), pose, {}))
    expected.emplace(splat.row, splat);
  ASSERT_GT(projected->splats.size(), 1000U);
  EXPECT_EQ(projected->splats.size() + projected->culled, cloud.size());
  float last_depth_m = 0.0F;
  for (const Splat& splat : projected->splats) {
    EXPECT_GE(splat.depth_m, last_depth_m);
    last_depth_m = splat.depth_m;
    const auto& reference = expected.at(splat.gaussian);
    EXPECT_NEAR(splat.u_px, reference.centre_px.x(), 1e-2);
    EXPECT_NEAR(splat.v_px, reference.centre_px.y(), 1e-2);
    EXPECT_NEAR(splat.depth_m, reference.depth_m, 1e-5);
    EXPECT_NEAR(splat.opacity, reference.opacity, 1e-6);
    Eigen::Matrix2d conic;
    conic << splat.conic[0], splat.conic[1], splat.conic[1], splat.conic[2];
    EXPECT_THAT(Eigen::Matrix2d(conic * reference.covariance_px2),
                test::IsNear(Eigen::Matrix2d::Identity(), 2e-2));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(splat.rgb[c], reference.rgb[c], 1e-5);
  }
}

TEST_P(ProjectOn, KeepsEveryGaussianThatReachesThePicture) {
  test::Random random(12);
  const auto cloud = test::random_cloud(random, {.count = 2000, .half_width_m = 12.0, .scale_max_m = 1.0});
  const auto projected = project(GetParam(), spans_of(cloud), *View::from(camera(), {}), {});
  ASSERT_TRUE(projected);
  std::vector<bool> kept(cloud.size(), false);
  for (const Splat& splat : projected->splats) kept[splat.gaussian] = true;
  for (const auto& splat : test::reference_splats(cloud, camera(), {}, {})) {
    const Eigen::Vector2d nearest(std::clamp(splat.centre_px.x(), 0.0, 319.0),
                                  std::clamp(splat.centre_px.y(), 0.0, 239.0));
    const Eigen::Vector2d d = nearest - splat.centre_px;
    const double alpha = splat.opacity * std::exp(-0.5 * d.dot(splat.covariance_px2.inverse() * d));
    EXPECT_TRUE(kept[splat.row] || alpha < 1.01 / 255.0) << splat.row;
  }
}

TEST_P(ProjectOn, AnEmptyCloudIsFine) {
  const gaussian::GaussianCloud empty;
  const auto projected = project(GetParam(), spans_of(empty), *View::from(camera(), {}), {});
  ASSERT_TRUE(projected);
  EXPECT_TRUE(projected->splats.empty());
}

INSTANTIATE_TEST_SUITE_P(Backends, ProjectOn, testing::ValuesIn(core::available_backends()),
                         [](const auto& backend) { return std::string(core::to_string(backend.param)); });

TEST(Project, SaysWhyCudaCannotRun) {
  if (core::built_with_cuda()) GTEST_SKIP() << "this build has a CUDA backend";
  const gaussian::GaussianCloud empty;
  const auto projected = project(core::Backend::kCuda, spans_of(empty), *View::from(camera(), {}), {});
  ASSERT_FALSE(projected);
  EXPECT_EQ(projected.error().code, Errc::kUnavailable);
}

TEST(View, RefusesCamerasItCannotDraw) {
  geometry::CameraModel model = camera();
  model.distortion[0] = 0.1;
  EXPECT_EQ(View::from(model, {}).error().code, Errc::kInvalidArgument);
  model = camera();
  model.kind = geometry::CameraKind::kFisheye;
  EXPECT_TRUE(View::from(model, {}));
  model.distortion[3] = 0.01;
  EXPECT_FALSE(View::from(model, {}));
  model = camera();
  model.width_px = 0;
  EXPECT_FALSE(View::from(model, {}));
  geometry::RigidTransform pose;
  pose.translation_m.x() = std::nan("");
  EXPECT_FALSE(View::from(camera(), pose));
}

TEST(ShBasis, IsOrthonormalOnTheSphere) {
  constexpr int kPoints = 20000;  // a Fibonacci lattice: equal areas
  Eigen::Matrix<double, 16, 16> products = Eigen::Matrix<double, 16, 16>::Zero();
  for (int i = 0; i < kPoints; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kPoints;
    const double phi = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    Eigen::Matrix<double, 16, 1> basis;
    sh_basis(3, r * std::cos(phi), r * std::sin(phi), z, basis.data());
    products += 4.0 * std::numbers::pi / kPoints * basis * basis.transpose();
  }
  EXPECT_THAT(products, test::IsNear(Eigen::Matrix<double, 16, 16>::Identity(), 2e-3));
}

TEST(Exp2Fast, IsWithinAMillionthOverItsRange) {
  for (int i = 0; i <= 200000; ++i) {
    const float x = 10.0F - 110.0F * static_cast<float>(i) / 200000.0F;
    const double exact = std::exp2(static_cast<double>(x));
    ASSERT_LT(std::abs(exp2_fast(x) - exact), 7e-7 * exact) << x;
  }
  EXPECT_EQ(exp2_fast(0.0F), 1.0F);
}

}  // namespace
}  // namespace edgesplat::splat
