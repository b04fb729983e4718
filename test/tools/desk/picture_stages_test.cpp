// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/picture_stages.hpp"

#include "test/tools/desk/wall_scene.hpp"

#include <gtest/gtest.h>

namespace edgesplat::desk {
namespace {

TEST(HalfSize, IsWhatASmallerCameraSees) {
  ScenePicture full = WallScene::shoot(1, 128, 96);
  full.weight.assign(128 * 96, 1.0F);
  full.weight[2 * 128 + 4] = 0.0F;  // of the small pixel (2, 1)
  full.depth_m.assign(128 * 96, 2.0F);
  full.depth_m[2 * 128 + 4] = 0.5F;
  const ScenePicture half = half_size(full);
  const ScenePicture truth = WallScene::shoot(1, 64, 48);
  EXPECT_EQ(half.camera.width_px, 64);
  EXPECT_NEAR(half.camera.fx_px, truth.camera.fx_px, 1e-9);
  EXPECT_NEAR(half.camera.cx_px, truth.camera.cx_px, 1e-9);
  double difference = 0.0;
  for (std::size_t i = 0; i < truth.picture.values.size(); ++i)
    difference += std::abs(int{half.picture.values[i]} - int{truth.picture.values[i]});
  EXPECT_LT(difference / static_cast<double>(truth.picture.values.size()), 1.5);
  for (std::size_t i = 0; i < half.weight.size(); ++i) EXPECT_EQ(half.weight[i], i == 64 + 2 ? 0.0F : 1.0F);
  EXPECT_EQ(half.depth_m[64 + 2], 0.5F) << "no mean of near and far";
  EXPECT_EQ(half.depth_m[64 + 3], 2.0F);
}

TEST(PictureStages, MakesSmallPicturesOnceAndForgetsThem) {
  const ScenePicture one = WallScene::shoot(1, 65, 49), two = WallScene::shoot(2, 64, 48);
  const std::vector<const ScenePicture*> pictures{&one, &two};
  PictureStages stages(pictures);
  EXPECT_EQ(&stages.at(1, 1), &two);
  const ScenePicture* small = &stages.at(0, 2);
  EXPECT_EQ(small->camera.width_px, 33);  // rounded
  EXPECT_EQ(&stages.at(0, 2), small);
  stages.forget_small();
  EXPECT_EQ(stages.at(0, 2).picture.width_px, 33);
}

}  // namespace
}  // namespace edgesplat::desk
