// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/quality/held_out_scores.hpp"

#include "common/io/image_file.hpp"
#include "robot/render/view.hpp"
#include "test/support/random_cloud.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace edgesplat::quality {
namespace {

/// The map is coloured blobs 3 m ahead; two keyframes and a picture between them show exactly that.
class HeldOutScoresTest : public testing::Test {
 protected:
  void SetUp() override {
    test::Random random(3);
    input_.map = test::random_cloud(random, {400, 0, 2.0, 2.9, 3.1, 0.05, 0.15});
    for (const double x_m : {-0.3, 0.3}) input_.keyframes.push_back(keyframe_at(x_m));
    HeldOutView view;
    view.stamp = host_time_from_ns(7);
    view.map_from_camera.translation_m.x() = 0.1;
    view.nearest_keyframe = most_alike(input_.keyframes, view.map_from_camera);
    view.block = 1;
    input_.views = {view};
    truth_.picture = drawn_from(0.1);
    input_.truth = [this](const HeldOutView&) -> Result<HeldOutTruth> { return truth_; };
  }

  static geometry::CameraModel camera() {
    return {geometry::CameraKind::kPinhole, 96, 64, 80.0, 80.0, 47.5, 31.5, {}};
  }
  sensor::ImageRgb8 drawn_from(double x_m) const {
    geometry::RigidTransform map_from_camera;
    map_from_camera.translation_m.x() = x_m;
    return render::draw_view(input_.map, camera(), map_from_camera.inverse()).value().picture;
  }
  SavedKeyframe keyframe_at(double x_m) const {
    SavedKeyframe keyframe;
    keyframe.map_from_camera.translation_m.x() = x_m;
    keyframe.camera = camera();
    keyframe.image = folder_ / (std::to_string(x_m) + ".png");
    EXPECT_TRUE(io::save_image(keyframe.image, drawn_from(x_m)));
    return keyframe;
  }
  /// The left third does not count.
  void count_the_right_only() {
    truth_.weight.assign(96 * 64, 1.0F);
    for (std::size_t i = 0; i < truth_.weight.size(); ++i) truth_.weight[i] = i % 96 < 32 ? 0.0F : 1.0F;
  }
  nlohmann::json score() const {
    const auto scores = score_held_out(input_, folder_ / "heldout");
    EXPECT_TRUE(scores) << scores.error().context;
    return to_json(*scores);
  }

  test::TempDir folder_;
  HeldOutInput input_;
  HeldOutTruth truth_;
};

TEST_F(HeldOutScoresTest, TheMapThatMadeThePictureIsEqualToItAndAKeyframeIsNot) {
  const nlohmann::json json = score();
  EXPECT_EQ(json["psnr_db"], 100.0);
  EXPECT_NEAR(json["ssim"].get<double>(), 1.0, 1e-6);
  EXPECT_LT(json["psnr_nearest_db"].get<double>(), 25.0);
  EXPECT_TRUE(json["psnr_seeded_db"].is_null());
  EXPECT_TRUE(json["lpips"].is_null());
  EXPECT_EQ(json["kind"], "simulated");
  EXPECT_EQ(json["movers_masked"], false);
  EXPECT_EQ(json["static_share"], 1.0);
  ASSERT_EQ(json["views"].size(), 1U);
  EXPECT_EQ(json["views"][0]["block"], 1);
  EXPECT_EQ(json["views"][0]["stamp_ns"], 7);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "heldout" / "000_weight.png"));
}

TEST_F(HeldOutScoresTest, WhatHasNoWeightDoesNotCount) {
  count_the_right_only();
  const nlohmann::json clean = score();
  EXPECT_EQ(clean["psnr_db"], 100.0);
  test::Random random(5);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 32; ++x) {
      for (int c = 0; c < 3; ++c) {
        truth_.picture.pixel(x, y)[c] = static_cast<std::uint8_t>(random.below(256));
      }
    }
  }
  nlohmann::json painted = score();
  EXPECT_EQ(painted, clean);  // to the last bit, every figure
  EXPECT_NEAR(painted["static_share"].get<double>(), 2.0 / 3.0, 1e-12);
  truth_.weight.clear();
  EXPECT_LT(score()["psnr_db"].get<double>(), 20.0);
}

TEST_F(HeldOutScoresTest, ShadowsOfMoversAreScoredApart) {
  EXPECT_TRUE(score()["psnr_with_shadows_db"].is_null());
  count_the_right_only();
  truth_.weight_with_shadows.assign(96 * 64, 1.0F);
  for (int y = 0; y < 64; ++y) {  // a shadow where only the second weights look
    for (int x = 0; x < 32; ++x) truth_.picture.pixel(x, y)[1] = 0;
  }
  const nlohmann::json json = score();
  EXPECT_EQ(json["psnr_db"], 100.0);
  EXPECT_LT(json["psnr_with_shadows_db"].get<double>(), 40.0);
  EXPECT_LT(json["psnr_nearest_with_shadows_db"].get<double>(), json["psnr_nearest_db"].get<double>());
}

TEST_F(HeldOutScoresTest, ARealRunShowsItsWeights) {
  count_the_right_only();
  input_.kind = HeldOutKind::kReal;
  input_.movers_masked = true;
  const nlohmann::json json = score();
  EXPECT_EQ(json["kind"], "real");
  EXPECT_EQ(json["movers_masked"], true);
  const auto weight = io::load_image(folder_ / "heldout" / "000_weight.png");
  ASSERT_TRUE(weight) << weight.error().context;
  const auto* picture = std::get_if<sensor::ImageGray8>(&*weight);
  ASSERT_NE(picture, nullptr);
  EXPECT_EQ(picture->width_px, 96);
  EXPECT_EQ(*picture->pixel(31, 60), 0);
  EXPECT_EQ(*picture->pixel(32, 3), 255);
}

TEST_F(HeldOutScoresTest, MeansAreOverTheViewsAndTheSeededMapIsScoredWhereThereIsOne) {
  input_.seeded = input_.map;
  for (float& opacity : input_.seeded->opacity_logits) opacity = -1.0F;
  input_.views.push_back(input_.views.front());
  const nlohmann::json json = score();
  ASSERT_EQ(json["views"].size(), 2U);
  EXPECT_EQ(json["views"][1]["pictures"], "001");
  EXPECT_EQ(json["psnr_nearest_db"], json["views"][0]["psnr_nearest_db"]);
  EXPECT_EQ(json["psnr_seeded_db"], json["views"][1]["psnr_seeded_db"]);
  EXPECT_LT(json["psnr_seeded_db"].get<double>(), 40.0);
}

TEST_F(HeldOutScoresTest, WithoutViewsThereAreNoMeans) {
  input_.views.clear();
  const nlohmann::json json = score();
  EXPECT_TRUE(json["psnr_db"].is_null());
  EXPECT_TRUE(json["static_share"].is_null());
  EXPECT_TRUE(json["views"].empty());
}

TEST_F(HeldOutScoresTest, PicturesOfAnotherSizeAreSaid) {
  truth_.picture = sensor::ImageRgb8(64, 96);
  const auto scores = score_held_out(input_, folder_ / "heldout");
  ASSERT_FALSE(scores);
  EXPECT_EQ(scores.error().code, Errc::kInvalidArgument);
}

}  // namespace
}  // namespace edgesplat::quality
