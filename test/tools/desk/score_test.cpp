// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/score.hpp"

#include "common/io/image_file.hpp"
#include "common/io/ply_gaussians.hpp"
#include "common/sensor/rig_config.hpp"
#include "kernels/image/undistort.hpp"
#include "robot/render/view.hpp"
#include "test/support/random_cloud.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <numeric>

namespace edgesplat::desk {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
const fs::path kMaskModel = EDGESPLAT_SOURCE_DIR "/../shared/models/espnetv2_s2_city";

/// The folder of a real run whose map is exactly what its camera saw: six keyframes along x, and between them
/// two blocks of two pictures held out. The camera's distortion leaves the corners of the undistorted picture
/// unseen.
class RealRun : public testing::Test {
 protected:
  void SetUp() override {
    sensor::Rig rig;
    rig.camera.emplace();
    rig.camera->model = {geometry::CameraKind::kPinhole, 160, 96, 120.0, 120.0, 79.5, 47.5,
                         {0.12, 0.0, 0.0, 0.0}};
    undistorter_.emplace(rig.camera->model);
    folder_.write("rig.toml", sensor::print_rig(rig));
    test::Random random(11);
    map_ = test::random_cloud(random, {600, 0, 2.5, 2.5, 4.0, 0.08, 0.2});
    for (const char* folder : {"robot/keyframes", "robot/heldout", "server"}) {
      fs::create_directories(folder_ / folder);
    }
    ASSERT_TRUE(io::write_gaussians_ply(folder_ / "robot/gaussians_at_input_end.ply", map_));
    for (int i = 0; i < 6; ++i) save("robot/keyframes", i, 0.3 * i, std::nullopt);
    const double held_out_at[] = {0.45, 0.51, 1.32, 1.38};
    for (int i = 0; i < 4; ++i) save("robot/heldout", i, held_out_at[i], i / 2);
  }

  [[nodiscard]] sensor::ImageRgb8 seen_from(double x_m) const {
    geometry::RigidTransform map_from_camera;
    map_from_camera.translation_m.x() = x_m;
    auto picture = render::draw_view(map_, undistorter_->model(), map_from_camera.inverse()).value().picture;
    for (std::size_t i = 0; i < undistorter_->seen().size(); ++i) {
      if (undistorter_->seen()[i] == 0.0F)
        std::fill_n(picture.values.begin() + 3 * static_cast<long>(i), 3, 0);
    }
    return picture;
  }
  /// As the robot does.
  void save(const std::string& folder, int number, double x_m, std::optional<int> block) {
    const auto& camera = undistorter_->model();
    nlohmann::json json = {
        {"keyframe", number},
        {"stamp_ns", static_cast<std::int64_t>(1e9 + 1e9 * x_m)},
        {"map_from_camera", {{"translation_m", {x_m, 0.0, 0.0}}, {"quaternion_xyzw", {0.0, 0.0, 0.0, 1.0}}}},
        {"camera",
         {{"width_px", camera.width_px},
          {"height_px", camera.height_px},
          {"fx_px", camera.fx_px},
          {"fy_px", camera.fy_px},
          {"cx_px", camera.cx_px},
          {"cy_px", camera.cy_px}}}};
    if (block) json["block"] = *block;
    const std::string stem = folder + "/00000" + std::to_string(number);
    folder_.write(stem + ".json", json.dump());
    ASSERT_TRUE(io::save_image(folder_ / (stem + ".jpg"), seen_from(x_m)));
  }
  [[nodiscard]] Result<nlohmann::json> score(const fs::path& mask = {}) const {
    ScoreOptions options;
    options.run = folder_.path();
    options.mask_model = mask;
    return score_run(options);
  }

  test::TempDir folder_;
  std::optional<image::Undistorter> undistorter_;
  gaussian::GaussianCloud map_;
};

TEST_F(RealRun, ItsMapIsComparedWithThePicturesHeldOut) {
  const auto json = score();
  ASSERT_TRUE(json) << json.error().context;
  // Of the map only JPEG's loss is left; the nearest keyframe is 0.03 to 0.15 m away, 1 to 7 px.
  EXPECT_GT((*json)["psnr_db"].get<double>(), 30.0);
  EXPECT_LT((*json)["psnr_nearest_db"].get<double>(), (*json)["psnr_db"].get<double>() - 6.0);
  EXPECT_EQ((*json)["kind"], "real");
  EXPECT_EQ((*json)["movers_masked"], false);
  const auto seen = undistorter_->seen();
  const double share = std::accumulate(seen.begin(), seen.end(), 0.0) / static_cast<double>(seen.size());
  ASSERT_LT(share, 0.995);
  EXPECT_NEAR((*json)["static_share"].get<double>(), share, 1e-9);
  EXPECT_TRUE((*json)["psnr_seeded_db"].is_null());
  ASSERT_EQ((*json)["views"].size(), 4U);
  EXPECT_EQ((*json)["views"][1]["block"], 0);
  EXPECT_EQ((*json)["views"][2]["block"], 1);
  // What is as near as 0.03 m is more alike than what is 0.15 m away.
  EXPECT_GT((*json)["views"][3]["psnr_nearest_db"].get<double>(),
            (*json)["views"][0]["psnr_nearest_db"].get<double>());
  for (const char* what : {"target", "map", "nearest", "weight"}) {
    EXPECT_TRUE(fs::exists(folder_ / ("heldout/003_" + std::string(what) + ".png"))) << what;
  }
  EXPECT_TRUE(fs::exists(folder_ / "heldout.json"));
}

TEST_F(RealRun, WhatTheCameraDidNotSeeDoesNotCount) {
  const double clean_db = score()->at("psnr_db").get<double>();
  const auto path = folder_ / "robot/heldout/000001.jpg";
  auto picture = io::load_rgb8(path).value();
  for (std::size_t i = 0; i < undistorter_->seen().size(); ++i) {
    if (undistorter_->seen()[i] == 0.0F) {
      std::fill_n(picture.values.begin() + 3 * static_cast<long>(i), 3, std::uint8_t{255});
    }
  }
  ASSERT_TRUE(io::save_image(path, picture));
  // JPEG's blocks carry a little of it to the pixels beside.
  EXPECT_NEAR(score()->at("psnr_db").get<double>(), clean_db, 1.5);
}

TEST_F(RealRun, TheSeededMapIsScoredWhereTheServerKeptIt) {
  gaussian::GaussianCloud seeded = map_;
  for (float& scale : seeded.log_scales) scale -= 0.7F;
  ASSERT_TRUE(io::write_gaussians_ply(folder_ / "server/seeded.ply", seeded));
  const auto json = score();
  ASSERT_TRUE(json) << json.error().context;
  EXPECT_LT((*json)["psnr_seeded_db"].get<double>(), (*json)["psnr_db"].get<double>() - 3.0);
}

TEST_F(RealRun, WithTheSegmentationModelTheWeightsAreItsToo) {
  if (!fs::exists(kMaskModel)) GTEST_SKIP() << kMaskModel << " is absent";
  const auto json = score(kMaskModel);
  ASSERT_TRUE(json) << json.error().context;
  EXPECT_EQ((*json)["movers_masked"], true);
  const auto loaded = io::load_image(folder_ / "heldout/002_weight.png");
  ASSERT_TRUE(loaded) << loaded.error().context;
  const auto& weight = std::get<sensor::ImageGray8>(*loaded);
  double counting = 0.0;
  for (std::size_t i = 0; i < weight.values.size(); ++i) {
    if (weight.values[i] == 0) continue;
    counting += 1.0;
    ASSERT_EQ(undistorter_->seen()[i], 1.0F);
  }
  EXPECT_NEAR((*json)["views"][2]["static_share"].get<double>(),
              counting / static_cast<double>(weight.values.size()), 1e-9);
}

TEST_F(RealRun, WhatIsMissingIsSaidWithWhatToDo) {
  auto json = score("/nonexistent/model");  // as if none were given
  EXPECT_TRUE(json);
  fs::remove(folder_ / "robot/heldout/000002.jpg");
  json = score();
  ASSERT_FALSE(json);
  EXPECT_THAT(json.error().context, HasSubstr("000002.jpg"));
  fs::remove_all(folder_ / "robot/heldout");
  json = score();
  ASSERT_FALSE(json);
  EXPECT_EQ(json.error().code, Errc::kNotFound);
  EXPECT_THAT(json.error().context, HasSubstr("--input"));
  EXPECT_THAT(json.error().context, HasSubstr("hold pictures out of mapping"));

  ScoreOptions options;
  options.run = folder_.path();
  options.input = folder_ / "none.mcap";
  EXPECT_EQ(score_run(options).error().code, Errc::kNotFound);
  options.run = "/nonexistent/run";
  options.input.clear();
  EXPECT_THAT(score_run(options).error().context, HasSubstr("/nonexistent/run"));
}

TEST_F(RealRun, APictureOfAnotherSizeThanTheCamerasIsRefused) {
  ASSERT_TRUE(io::save_image(folder_ / "robot/heldout/000000.jpg", sensor::ImageRgb8(96, 160)));
  // As many pixels, other sides; then fewer.
  EXPECT_EQ(score().error().code, Errc::kInvalidArgument);
  ASSERT_TRUE(io::save_image(folder_ / "robot/heldout/000000.jpg", sensor::ImageRgb8(96, 64)));
  const auto json = score();
  ASSERT_FALSE(json);
  EXPECT_EQ(json.error().code, Errc::kCorrupt);
  EXPECT_THAT(json.error().context, HasSubstr("rig.toml"));
}

}  // namespace
}  // namespace edgesplat::desk
