// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/render/view.hpp"

#include "test/support/random_cloud.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace edgesplat::render {
namespace {

const geometry::CameraModel kCamera{geometry::CameraKind::kPinhole, 64, 48, 50.0, 50.0, 31.5, 23.5, {}};

std::shared_ptr<const gaussian::GaussianCloud> cloud(std::uint64_t seed) {
  test::Random random(seed);
  return std::make_shared<const gaussian::GaussianCloud>(test::random_cloud(random, {.count = 200}));
}

TEST(ViewDrawer, DrawsWhatTheCpuDrawsOnTheFastestBackend) {
  ViewDrawer drawer;
  EXPECT_EQ(drawer.backend(), core::available_backends().back());
  for (const std::uint64_t seed : {1U, 2U, 1U}) {
    const auto gaussians = cloud(seed);
    for (const double x_m : {0.0, 0.3}) {
      const geometry::RigidTransform pose{Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}};
      const auto drawn = drawer.draw(gaussians, kCamera, pose);
      const auto expected = draw_view(*gaussians, kCamera, pose);
      ASSERT_TRUE(drawn && expected);
      ASSERT_EQ(drawn->picture.values.size(), expected->picture.values.size());
      std::size_t off = 0;
      for (std::size_t i = 0; i < expected->picture.values.size(); ++i)
        off += std::abs(drawn->picture.values[i] - expected->picture.values[i]) > 2 ? 1U : 0U;
      EXPECT_LT(off, expected->picture.values.size() / 500);
    }
  }
  EXPECT_TRUE(drawer.gpu_failure().empty());
}

TEST(ViewDrawer, SaysWhatIsWrongWithACameraAndStaysWhereItIs) {
  ViewDrawer drawer;
  geometry::CameraModel distorted = kCamera;
  distorted.distortion[0] = 0.1;
  const auto drawn = drawer.draw(cloud(1), distorted, {});
  ASSERT_FALSE(drawn);
  EXPECT_EQ(drawn.error().code, Errc::kInvalidArgument);
  EXPECT_EQ(drawer.backend(), core::available_backends().back());
}

}  // namespace
}  // namespace edgesplat::render
