// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/start_gaps.hpp"

#include "test/tools/desk/wall_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::desk {
namespace {

/// Points stand for the left half of the wall alone.
class GaussiansInGaps : public testing::Test {
 protected:
  GaussiansInGaps() {
    for (int i = 0; i < 6; ++i) shots_.push_back(WallScene::shoot(i, 128, 96));
    for (const ScenePicture& shot : shots_) pictures_.push_back(&shot);
    for (double x = -2.0; x < 0.0; x += kSpacing_m)
      for (double y = -1.5; y < 1.5; y += kSpacing_m) add_point(x, y);
  }
  void add_point(double x_m, double y_m) {
    gaussian::GaussianCloud one;
    one.resize(1);
    one.ids[0] = ids_.next();
    one.means_m = {static_cast<float>(kScale * x_m), static_cast<float>(kScale * y_m), 0.0F};
    one.log_scales.assign(3, static_cast<float>(std::log(kScale * kSpacing_m)));
    one.quats_xyzw = {0.0F, 0.0F, 0.0F, 1.0F};
    start_.append_row(one, 0);
  }
  [[nodiscard]] gaussian::GaussianCloud fill(std::size_t most) {
    auto filled = gaussians_in_gaps(pictures_, start_, {.scale = kScale, .most = most}, ids_);
    EXPECT_TRUE(filled);
    return filled ? *filled : gaussian::GaussianCloud{};
  }
  static constexpr double kScale = 5.0, kSpacing_m = 0.04;
  std::vector<ScenePicture> shots_;
  std::vector<const ScenePicture*> pictures_;
  mapping::IdAllocator ids_{1};
  gaussian::GaussianCloud start_;
};

TEST_F(GaussiansInGaps, LieOnTheWallWhereNoPointIs) {
  const auto filled = fill(100'000);
  ASSERT_TRUE(filled.consistent());
  ASSERT_GT(filled.size(), 300U);
  std::size_t on_wall = 0, within = 0, right = 0;
  for (std::size_t row = 0; row < filled.size(); ++row) {
    const double x_m = filled.means_m[3 * row] / kScale, y_m = filled.means_m[3 * row + 1] / kScale,
                 z_m = filled.means_m[3 * row + 2] / kScale;
    right += x_m > -0.1 ? 1U : 0U;
    if (std::abs(x_m) > 0.8 || std::abs(y_m) > 0.5) continue;  // seen by several pictures
    ++within;
    on_wall += std::abs(z_m) < 0.2 ? 1U : 0U;
    const auto truth = WallScene::colour(x_m, y_m);
    const float green = 0.5F + gaussian::GaussianCloud::kShC0 * filled.sh[3 * row + 1];
    if (std::abs(z_m) < 0.05) {
      EXPECT_NEAR(green, truth[1], 0.35F) << "the picture's colour";
    }
  }
  EXPECT_GT(static_cast<double>(right), 0.95 * static_cast<double>(filled.size()));
  EXPECT_GT(static_cast<double>(on_wall), 0.8 * static_cast<double>(within));
}

TEST_F(GaussiansInGaps, AreNotFilledTwice) {
  const auto first = fill(100'000);
  for (std::size_t row = 0; row < first.size(); ++row) start_.append_row(first, row);
  EXPECT_LT(fill(100'000).size(), first.size() / 10);
}

TEST_F(GaussiansInGaps, KeepToTheirNumberAndLeaveOutWhatDoesNotCount) {
  EXPECT_EQ(fill(50).size(), 50U);
  for (ScenePicture& shot : shots_) shot.weight.assign(128 * 96, 0.0F);
  EXPECT_EQ(fill(50).size(), 0U);
}

TEST_F(GaussiansInGaps, ArriveNowhereWithoutAnythingToGoBy) {
  start_ = {};
  pictures_.resize(1);
  EXPECT_EQ(fill(50).size(), 0U) << "one picture alone tells no depth";
}

}  // namespace
}  // namespace edgesplat::desk
