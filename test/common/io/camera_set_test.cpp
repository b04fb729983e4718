// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/camera_set.hpp"
#include "common/io/image_file.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>

#include <numbers>
#include <random>

namespace edgesplat::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::string_view kOwn = R"({"cameras": [
  {"name": "front", "width": 640, "height": 480, "fx": 500, "fy": 510, "cx": 319.5, "cy": 239.5,
   "distortion": [0.1, -0.2, 0.01, 0.02], "image": "a/front.jpg",
   "map_from_camera": [[0, 0, 1, 1], [-1, 0, 0, 2], [0, -1, 0, 3]]}]})";

// The camera stands at (1, 2, 3), y up, looking along -z of the scene.
constexpr std::string_view kNerf = R"({
  "fl_x": 100, "w": 64, "h": 48, "cx": 32, "cy": 24, "k1": 0.1, "p2": 0.3, "ply_file_path": "points.ply",
  "frames": [
    {"file_path": "./images/a.png", "transform_matrix": [[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]},
    {"file_path": "images/b/a.png", "depth_file_path": "depth/a.png", "fl_x": 200, "k1": 0, "transform_matrix": [[2,0,0,1],[0,2,0,2],[0,0,2,3]]}]})";

std::string refusal(std::string text, std::string_view from, std::string_view to) {
  text.replace(text.find(from), from.size(), to);
  const auto set = parse_camera_set(text);
  return set ? "accepted" : set.error().context;
}

TEST(CameraSet, ReadsItsOwnForm) {
  const auto set = parse_camera_set(kOwn);
  ASSERT_TRUE(set) << set.error().context;
  ASSERT_EQ(set->cameras.size(), 1U);
  const PosedCamera& camera = set->cameras[0];
  EXPECT_EQ(camera.name, "front");
  EXPECT_EQ(camera.image, "a/front.jpg");
  EXPECT_EQ(camera.camera.height_px, 480);
  EXPECT_EQ(camera.camera.fy_px, 510.0);
  EXPECT_THAT(camera.camera.distortion, ElementsAre(0.1, -0.2, 0.01, 0.02));
  const Eigen::Vector3d ahead = camera.map_from_camera * Eigen::Vector3d(0, 0, 5);
  EXPECT_TRUE(ahead.isApprox(Eigen::Vector3d(6, 2, 3), 1e-12)) << ahead.transpose();
}

TEST(CameraSet, ReadsNerfstudiosForm) {
  const auto set = parse_camera_set(kNerf);
  ASSERT_TRUE(set) << set.error().context;
  ASSERT_EQ(set->cameras.size(), 2U);
  EXPECT_EQ(set->points, "points.ply");
  const PosedCamera& first = set->cameras[0];
  const PosedCamera& second = set->cameras[1];
  EXPECT_EQ(first.name, "a");
  EXPECT_EQ(second.name, "a_1");
  EXPECT_TRUE(first.depth.empty());
  EXPECT_EQ(second.depth, "depth/a.png");
  // The middle of a 64 px wide picture lies between pixels 31 and 32.
  EXPECT_EQ(first.camera.cx_px, 31.5);
  EXPECT_THAT(first.camera.distortion, ElementsAre(0.1, 0.0, 0.0, 0.3));
  EXPECT_EQ(first.camera.fy_px, 100.0);
  EXPECT_EQ(second.camera.fx_px, 200.0);
  EXPECT_EQ(second.camera.distortion[0], 0.0);
  for (const PosedCamera& camera : set->cameras) {  // the second has a scale of 2, which a pose has not
    const Eigen::Vector3d ahead = camera.map_from_camera * Eigen::Vector3d(0, 0, 1);
    const Eigen::Vector3d below = camera.map_from_camera * Eigen::Vector3d(0, 1, 0);
    EXPECT_TRUE(ahead.isApprox(Eigen::Vector3d(1, 2, 2), 1e-12)) << ahead.transpose();
    EXPECT_TRUE(below.isApprox(Eigen::Vector3d(1, 1, 3), 1e-12)) << below.transpose();
  }
}

TEST(CameraSet, ReadsAThirdRadialTerm) {
  std::string text(kNerf);
  text.replace(text.find("\"p2\""), 4, "\"k3\"");
  const auto nerf = parse_camera_set(text);
  ASSERT_TRUE(nerf) << nerf.error().context;
  EXPECT_EQ(nerf->cameras[0].camera.k3, 0.3);
  EXPECT_THAT(nerf->cameras[0].camera.distortion, ElementsAre(0.1, 0.0, 0.0, 0.0));
  text = kOwn;
  text.replace(text.find("0.02]"), 5, "0.02, 0.5]");
  const auto own = parse_camera_set(text);
  ASSERT_TRUE(own) << own.error().context;
  EXPECT_EQ(own->cameras[0].camera.k3, 0.5);
}

TEST(CameraSet, TakesSizesFromImagesAndFocalLengthsFromAngles) {
  const test::TempDir folder;
  std::filesystem::create_directories(folder / "train");
  ASSERT_TRUE(save_image(folder / "train" / "r_0.png", sensor::ImageRgb8(40, 30)));
  const auto file = folder.write("transforms.json",
                                 R"({"fl_x": 50, "cx": 20, "cy": 15, "frames": [{"file_path": "./train/r_0",
      "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]}]})");
  const auto set = read_camera_set(file);
  ASSERT_TRUE(set) << set.error().context;
  EXPECT_EQ(set->cameras[0].camera.width_px, 40);
  EXPECT_EQ(image_path(file, set->cameras[0]), folder / "./train/r_0.png");
  const std::string angle = std::to_string(std::numbers::pi / 2);
  const auto wide = parse_camera_set(R"({"w": 64, "h": 48, "camera_angle_x": )" + angle +
                                     R"(, "frames": [{"file_path": "a",
      "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]}]})");
  ASSERT_TRUE(wide) << wide.error().context;
  EXPECT_NEAR(wide->cameras[0].camera.fx_px, 32.0, 1e-3);
}

TEST(CameraSet, SaysWhatIsWrong) {
  const std::string own(kOwn), nerf(kNerf);
  EXPECT_THAT(refusal(own, "{\"cameras\"", "{\"camera\""), HasSubstr("neither"));
  EXPECT_THAT(refusal(own, "500", "\"500\""), HasSubstr("camera 0: \"fx\""));
  EXPECT_THAT(refusal(own, "500", "-1"), HasSubstr("focal lengths must be positive"));
  EXPECT_THAT(refusal(own, "500", "1e999"), ::testing::Not("accepted"));
  EXPECT_THAT(refusal(own, "640", "1e9"), HasSubstr("\"width\""));
  EXPECT_THAT(refusal(own, "[0, 0, 1, 1]", "[0, 0, 1]"), HasSubstr("row"));
  EXPECT_THAT(refusal(own, "[0, 0, 1, 1]", "[0, 0, -1, 1]"), HasSubstr("no rotation"));  // a mirror
  EXPECT_THAT(refusal(own, "[0, 0, 1, 1]", "[0, 0, 2, 1]"), HasSubstr("no rotation"));
  EXPECT_THAT(refusal(own, "[0.1, -0.2, 0.01, 0.02]", "[0.1]"), HasSubstr("distortion"));
  EXPECT_THAT(refusal(own, "[0.1, -0.2, 0.01, 0.02]", "[0.1, 0, 0, 0, 0, 0]"), HasSubstr("distortion"));
  EXPECT_THAT(refusal(own, "[0.1, -0.2, 0.01, 0.02]", "[0.1, 0, 0, 0, \"0\"]"), HasSubstr("distortion"));
  EXPECT_THAT(refusal(nerf, "\"k1\"", "\"k4\""), HasSubstr("undistort the images first"));
  EXPECT_THAT(refusal(nerf, "\"fl_x\": 100, ", ""), HasSubstr("no focal length"));
  EXPECT_THAT(refusal(nerf, "\"fl_x\": 100", "\"camera_model\": \"EQUIRECTANGULAR\""),
              HasSubstr("EQUIRECTANGULAR"));
  EXPECT_THAT(refusal(nerf, "./images/a.png", ""), HasSubstr("frame 0: \"file_path\""));
  EXPECT_THAT(refusal(nerf, "\"depth/a.png\"", "7"), HasSubstr("\"depth_file_path\" is not a text"));
  EXPECT_THAT(parse_camera_set("{\"frames\": []}").error().context, HasSubstr("no camera"));
  EXPECT_EQ(read_camera_set("/nonexistent.json").error().code, Errc::kNotFound);
}

TEST(CameraSet, DamageIsSurvived) {
  std::mt19937 random(5);
  for (const std::string_view text : {kOwn, kNerf}) {
    for (std::size_t length = 0; length < text.size() - 1; ++length) {
      ASSERT_FALSE(parse_camera_set(text.substr(0, length))) << length;
    }
    for (int round = 0; round < 3000; ++round) {
      std::string damaged(text);
      for (int i = 0; i < 3; ++i) damaged[random() % damaged.size()] = static_cast<char>(random());
      (void)parse_camera_set(damaged);
    }
  }
  (void)parse_camera_set(std::string(100'000, '['));
}

}  // namespace
}  // namespace edgesplat::io
