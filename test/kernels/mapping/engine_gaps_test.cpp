// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/engine.hpp"
#include "test/kernels/mapping/patterned_wall.hpp"

#include <gtest/gtest.h>

namespace edgesplat::mapping {
namespace {

/// A robot that drives towards the wall; its LiDAR measures a strip of it below the picture's middle, its
/// camera sees all of it. The body is the camera.
class EngineGaps : public testing::Test {
 protected:
  explicit EngineGaps() {
    options_.seen_through.enabled = false;
    options_.moving.enabled = false;
  }
  std::unique_ptr<MappingEngine> engine() {
    auto made = MappingEngine::create(options_, ids_, clock_);
    EXPECT_TRUE(made);
    return std::move(*made);
  }
  static void drive_to(double z_m, MappingEngine& engine) {
    map::Keyframe keyframe;
    keyframe.id = {static_cast<std::uint32_t>(std::lround(10.0 * z_m))};
    keyframe.camera.emplace();
    keyframe.camera->model = patterned_wall::camera();
    keyframe.exposure_s = 0.01F;
    const auto depth_m = static_cast<float>(patterned_wall::kWall_m - z_m);
    for (float x = -6.0F; x < 6.0F; x += 0.1F) {
      for (float y = 0.5F; y < 1.0F; y += 0.1F)
        keyframe.points_in_body.push_back({{x, y, depth_m}, {90, 90, 90}, true});
    }
    geometry::RigidTransform map_from_body;
    map_from_body.translation_m.z() = z_m;
    const StoredView view = patterned_wall::seen_from(map_from_body.translation_m);
    ASSERT_TRUE(engine.add(keyframe, map_from_body, &view.picture));
  }
  /// Of the Gaussians over the measured strip (y is down), those at the wall.
  static std::pair<int, int> over_the_strip(const gaussian::GaussianCloud& cloud) {
    int at_wall = 0, elsewhere = 0;
    for (std::size_t row = 0; row < cloud.size(); ++row) {
      if (cloud.means_m[3 * row + 1] > 0.3F) continue;
      ++(std::abs(cloud.means_m[3 * row + 2] - static_cast<float>(patterned_wall::kWall_m)) < 1.5F
             ? at_wall
             : elsewhere);
    }
    return {at_wall, elsewhere};
  }
  EngineOptions options_;
  IdAllocator ids_{7};
  SteadyClock clock_;
};

TEST_F(EngineGaps, WhatOnlyTheCameraSeesIsSeededWherePicturesPutIt) {
  const auto engine = this->engine();
  drive_to(0.0, *engine);
  EXPECT_EQ(over_the_strip(engine->cloud()).first, 0) << "one picture does not tell depths";
  EXPECT_FALSE(engine->views().size() == 0);
  drive_to(0.5, *engine);
  drive_to(1.0, *engine);
  const auto [at_wall, elsewhere] = over_the_strip(engine->cloud());
  EXPECT_GT(at_wall, 500);
  EXPECT_LT(elsewhere, at_wall / 3) << "straight ahead nothing tells the depth";
}

TEST_F(EngineGaps, WhatHasBeenSeededIsTrainedOn) {
  const auto engine = this->engine();
  drive_to(0.0, *engine);
  drive_to(0.5, *engine);
  const auto views = engine->take_views();
  const auto unmapped = [](const StoredView& view) {
    return std::count(view.unmapped.begin(), view.unmapped.end(), true);
  };
  EXPECT_GT(unmapped(views[0]), 4000) << "all over the strip";
  EXPECT_LT(unmapped(views[1]), unmapped(views[0]) / 5);
}

TEST_F(EngineGaps, CanBeSwitchedOff) {
  options_.sweep.enabled = false;
  const auto engine = this->engine();
  drive_to(0.0, *engine);
  drive_to(0.5, *engine);
  EXPECT_EQ(over_the_strip(engine->cloud()).first, 0);
}

TEST_F(EngineGaps, LargePicturesAreTrainedOnAtAWholeFractionOfTheirSize) {
  options_.most_pixels = 4000;  // of 15 360: half of each side
  const auto engine = this->engine();
  drive_to(0.0, *engine);
  ASSERT_TRUE(engine->step());
  const auto views = engine->take_views();
  EXPECT_EQ(views[0].picture.width_px, patterned_wall::kWidth_px / 2);
  EXPECT_EQ(views[0].camera().width_px, patterned_wall::kWidth_px / 2);
  EXPECT_DOUBLE_EQ(views[0].camera().fx_px, 60.0);
}

}  // namespace
}  // namespace edgesplat::mapping
