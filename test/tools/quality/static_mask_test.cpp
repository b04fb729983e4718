// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/quality/static_mask.hpp"

#include "common/io/image_file.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <string_view>

namespace edgesplat::quality {
namespace {

const std::filesystem::path kModels = EDGESPLAT_SOURCE_DIR "/../shared/models";
const std::filesystem::path kModel = kModels / "espnetv2_s2_city";
constexpr const char* kFile = "espnetv2_s2_city_384x640.onnx";

/// A street in front of a traffic light: 1242x375, a car ahead, one left, a lorry right, the sky above.
const std::filesystem::path kStreet =
    EDGESPLAT_SOURCE_DIR "/../shared/data/kitti_drive0052_78scans_images/image_02/0000000000.jpg";

struct Place {
  int x_px, y_px;
};
constexpr Place kMovers[] = {{630, 250}, {200, 280}, {900, 150}, {420, 190}};  // car, car, lorry, lorry
constexpr Place kStatic[] = {{700, 20}, {200, 30}, {480, 340}, {60, 40}, {560, 120}};  // sky, road, trees

float at(const std::vector<float>& weight, const sensor::ImageRgb8& picture, Place place) {
  return weight[static_cast<std::size_t>(place.y_px) * static_cast<std::size_t>(picture.width_px) +
                static_cast<std::size_t>(place.x_px)];
}

double share(const std::vector<float>& weight) {
  return std::accumulate(weight.begin(), weight.end(), 0.0) / static_cast<double>(weight.size());
}

TEST(StaticMask, CarsAndLorriesDoNotCountAndSkyRoadAndTreesDo) {
  if (!std::filesystem::exists(kModel)) GTEST_SKIP() << kModel << " is absent";
  if (!std::filesystem::exists(kStreet)) GTEST_SKIP() << kStreet << " is absent";
  const auto picture = io::load_rgb8(kStreet);
  ASSERT_TRUE(picture) << picture.error().context;
  auto mask = StaticMask::load(kModel);
  ASSERT_TRUE(mask) << mask.error().context;
  const auto weights = mask->weights(*picture);
  ASSERT_TRUE(weights) << weights.error().context;
  const std::vector<float>* weight = &weights->without_movers;
  ASSERT_EQ(weight->size(), picture->values.size() / 3);
  for (const Place place : kMovers) EXPECT_EQ(at(*weight, *picture, place), 0.0F) << place.x_px;
  for (const Place place : kStatic) EXPECT_EQ(at(*weight, *picture, place), 1.0F) << place.x_px;
  for (const float w : *weight) ASSERT_TRUE(w == 0.0F || w == 1.0F);
  // What onnxruntime and OpenCV's Python module make of the same network, resizing and margin.
  EXPECT_NEAR(share(*weight), 0.461, 0.005);

  EXPECT_EQ(mask->weights(*picture)->without_movers, *weight);
  auto again = StaticMask::load(kModel);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->weights(*picture)->without_movers, *weight);
}

TEST(StaticMask, ShadowsAreTheGroundCloseToMoversAndNothingElse) {
  if (!std::filesystem::exists(kModel)) GTEST_SKIP() << kModel << " is absent";
  if (!std::filesystem::exists(kStreet)) GTEST_SKIP() << kStreet << " is absent";
  const auto picture = io::load_rgb8(kStreet);
  auto mask = StaticMask::load(kModel);
  ASSERT_TRUE(picture && mask);
  const auto weights = mask->weights(*picture);
  ASSERT_TRUE(weights) << weights.error().context;
  for (std::size_t i = 0; i < weights->without_movers.size(); ++i)
    ASSERT_LE(weights->without_shadows[i], weights->without_movers[i]);
  // The shadow at the feet of the car ahead counts with shadows, and not without.
  constexpr Place kShadow = {540, 305};
  EXPECT_EQ(at(weights->without_movers, *picture, kShadow), 1.0F);
  EXPECT_EQ(at(weights->without_shadows, *picture, kShadow), 0.0F);
  constexpr Place kSkyOverTheLorry = {840, 12};
  EXPECT_EQ(at(weights->without_shadows, *picture, kSkyOverTheLorry), 1.0F);
  EXPECT_GT(share(weights->without_shadows), 0.25);
}

TEST(StaticMask, TakesPicturesOfAnySize) {
  if (!std::filesystem::exists(kModel)) GTEST_SKIP() << kModel << " is absent";
  auto mask = StaticMask::load(kModel);
  ASSERT_TRUE(mask) << mask.error().context;
  EXPECT_EQ(mask->weights({1, 1})->without_movers.size(), 1U);
  EXPECT_EQ(mask->weights({640, 384})->without_shadows.size(), 640U * 384U);
  EXPECT_EQ(mask->weights({40, 900})->without_movers.size(), 40U * 900U);
  EXPECT_EQ(mask->weights({}).error().code, Errc::kInvalidArgument);
}

TEST(StaticMask, AMissingNetworkIsNotFoundAndDamageIsSaid) {
  EXPECT_EQ(StaticMask::load("/nonexistent").error().code, Errc::kNotFound);
  const test::TempDir folder;
  folder.write(kFile, std::string_view("no network at all"));
  EXPECT_EQ(StaticMask::load(folder.path()).error().code, Errc::kCorrupt);
  folder.write(kFile, std::string_view());
  EXPECT_EQ(StaticMask::load(folder.path()).error().code, Errc::kCorrupt);
}

TEST(StaticMask, AnotherNetworkIsRefused) {
  const auto lpips = kModels / "lpips_alex" / "lpips_alex_feats_256x256.onnx";
  const auto smaller = kModel / "espnetv2_s2_city_256x512.onnx";
  if (!std::filesystem::exists(lpips)) GTEST_SKIP() << lpips << " is absent";
  if (!std::filesystem::exists(smaller)) GTEST_SKIP() << smaller << " is absent";
  for (const auto& other : {lpips, smaller}) {
    const test::TempDir folder;
    std::filesystem::copy_file(other, folder / kFile);
    const auto mask = StaticMask::load(folder.path());
    ASSERT_FALSE(mask) << other;
    EXPECT_EQ(mask.error().code, Errc::kCorrupt);
    EXPECT_NE(mask.error().context.find(kFile), std::string::npos);
  }
}

}  // namespace
}  // namespace edgesplat::quality
