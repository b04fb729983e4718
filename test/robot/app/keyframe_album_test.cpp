// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/keyframe_album.hpp"

#include "common/io/image_file.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <fstream>

namespace edgesplat::app {
namespace {

std::shared_ptr<const map::Keyframe> keyframe(std::uint32_t id) {
  auto made = std::make_shared<map::Keyframe>();
  made->id = map::KeyframeId{id};
  made->odom_from_body.translation_m = {0.5 * id, 0.0, 0.0};
  made->camera.emplace();
  made->camera->model = {geometry::CameraKind::kPinhole, 32, 24, 30.0, 30.0, 16.0, 12.0, {-0.1, 0, 0, 0}};
  auto image = std::make_shared<map::EncodedImage>();
  image->bytes = *io::encode_jpeg(sensor::ImageRgb8(32, 24, 128), 90);
  made->image = image;
  made->points_in_body = {{{0.0F, 0.0F, 2.0F}, {1, 2, 3}, true}};
  return made;
}

TEST(KeyframeAlbum, WritesEveryPictureButOnlyAFewWhole) {
  KeyframeAlbum album(4);
  for (std::uint32_t id = 0; id < 20; ++id) album.add(keyframe(id));
  const test::TempDir folder;
  geometry::RigidTransform map_from_odom;
  map_from_odom.translation_m = {0.0, 7.0, 0.0};
  const Status written = album.write(folder.path(), {}, map_from_odom);
  ASSERT_TRUE(written) << written.error().context;

  int pictures = 0;
  int overlays = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "keyframes")) {
    pictures += entry.path().extension() == ".jpg" ? 1 : 0;
    overlays += entry.path().extension() == ".png" ? 1 : 0;
  }
  EXPECT_EQ(pictures, 20);
  EXPECT_EQ(overlays, static_cast<int>(album.size()));
  EXPECT_LE(album.size(), 4U);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "renders" / "000000.png"));

  std::ifstream text(folder.path() / "keyframes" / "000003.json");
  const auto json = nlohmann::json::parse(text);
  EXPECT_DOUBLE_EQ(json["map_from_camera"]["translation_m"][0].get<double>(), 1.5);
  EXPECT_DOUBLE_EQ(json["map_from_camera"]["translation_m"][1].get<double>(), 7.0);
}

TEST(KeyframeAlbum, WritesPatchesWhereTheUndistortedPictureShowsThem) {
  KeyframeAlbum album(4);
  const auto made = keyframe(0);
  // The second lies where the undistorted picture does not reach any more.
  album.add(made, {{{10.0F, 8.0F}, 16.0F, 0.5F, true},
                   {{-40.0F, 8.0F}, 16.0F, 0.5F, true},
                   {{25.0F, 20.0F}, 16.0F, 13.0F, false}});
  album.add(keyframe(1));
  const test::TempDir folder;
  const Status written = album.write(folder.path(), {}, {});
  ASSERT_TRUE(written) << written.error().context;
  std::ifstream file(folder.path() / "keyframes" / "000000_patches.csv");
  std::string header, first, last, none;
  std::getline(file, header);
  std::getline(file, first);
  std::getline(file, last);
  EXPECT_EQ(header, "x_px,y_px,side_px,misfit,used");
  const geometry::CameraModel& camera = made->camera->model;
  const Eigen::Vector3d ray = camera.unproject({10.0, 8.0});
  double x = 0.0, y = 0.0;
  ASSERT_EQ(std::sscanf(first.c_str(), "%lf,%lf,16,0.50,1", &x, &y), 2) << first;
  EXPECT_NEAR(x, camera.cx_px + camera.fx_px * ray.x() / ray.z(), 0.06);
  EXPECT_NEAR(y, camera.cy_px + camera.fy_px * ray.y() / ray.z(), 0.06);
  EXPECT_TRUE(last.ends_with(",16,13.00,0")) << last;
  EXPECT_FALSE(std::getline(file, none));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "keyframes" / "000001_patches.csv"));
}

TEST(KeyframeAlbum, WritesWhatWasHeldOutApart) {
  KeyframeAlbum album(4);
  album.add(keyframe(0));
  album.add_held_out(keyframe(7), 0);
  album.add_held_out(keyframe(8), 1);
  const test::TempDir folder;
  const Status written = album.write(folder.path(), {}, {});
  ASSERT_TRUE(written) << written.error().context;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "heldout" / "000000.jpg"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "heldout" / "000002.jpg"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "keyframes" / "000001.jpg"));
  std::ifstream text(folder.path() / "heldout" / "000001.json");
  const auto json = nlohmann::json::parse(text);
  EXPECT_DOUBLE_EQ(json["map_from_camera"]["translation_m"][0].get<double>(), 4.0);
  EXPECT_EQ(json["block"], 1);
  std::ifstream keyframe_text(folder.path() / "keyframes" / "000000.json");
  EXPECT_FALSE(nlohmann::json::parse(keyframe_text).contains("block"));
}

TEST(KeyframeAlbum, LeavesOutWhatHasNoPicture) {
  KeyframeAlbum album(4);
  auto blind = std::make_shared<map::Keyframe>(*keyframe(0));
  blind->image = nullptr;
  album.add(blind);
  EXPECT_EQ(album.size(), 0U);
}

}  // namespace
}  // namespace edgesplat::app
