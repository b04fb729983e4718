// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/scene.hpp"
#include "test/tools/desk/colmap_scene.hpp"
#include "test/tools/desk/wall_scene.hpp"
#include "tools/desk/scene_start.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <functional>

namespace edgesplat::desk {
namespace {

using ::testing::HasSubstr;

std::vector<const ScenePicture*> pointers(const std::vector<ScenePicture>& pictures) {
  std::vector<const ScenePicture*> out;
  out.reserve(pictures.size());
  for (const ScenePicture& picture : pictures) out.push_back(&picture);
  return out;
}

SceneOptions with(const std::function<void(SceneOptions&)>& change) {
  SceneOptions options;
  change(options);
  return options;
}

TEST(ReadScene, GivesPicturesWithPosesAndPoints) {
  const test::TempDir folder;
  write_wall_scene(folder, 4, 64, 48);
  std::filesystem::remove(folder / "images" / "view1.png");
  const auto scene = read_scene(folder.path(), {});
  ASSERT_TRUE(scene) << scene.error().context;
  EXPECT_EQ(scene->images_missing, 1U);
  ASSERT_EQ(scene->pictures.size(), 3U);
  const ScenePicture truth = WallScene::shoot(2, 64, 48);
  const ScenePicture& read = scene->pictures[1];
  EXPECT_EQ(read.name, "view2");
  EXPECT_EQ(read.picture.values, truth.picture.values);
  EXPECT_TRUE(read.weight.empty());
  EXPECT_TRUE(read.map_from_camera.matrix().isApprox(truth.map_from_camera.matrix(), 1e-12));
  EXPECT_NEAR(read.camera.cx_px, truth.camera.cx_px, 1e-12);
  EXPECT_TRUE(scene->points.points_m.empty());
}

TEST(ReadScene, ShrinksPicturesAndCameras) {
  const test::TempDir folder;
  write_wall_scene(folder, 1, 128, 96);
  const auto half = read_scene(folder.path(), with([](SceneOptions& o) { o.downscale = 2.0; }));
  ASSERT_TRUE(half) << half.error().context;
  const ScenePicture small = WallScene::shoot(0, 64, 48);
  ASSERT_EQ(half->pictures[0].camera.width_px, 64);
  EXPECT_NEAR(half->pictures[0].camera.fx_px, small.camera.fx_px, 1e-9);
  EXPECT_NEAR(half->pictures[0].camera.cx_px, small.camera.cx_px, 1e-9);
  double difference = 0.0;
  for (std::size_t i = 0; i < small.picture.values.size(); ++i) {
    difference += std::abs(int{half->pictures[0].picture.values[i]} - int{small.picture.values[i]});
  }
  EXPECT_LT(difference / static_cast<double>(small.picture.values.size()), 1.5);
  const auto bounded = read_scene(folder.path(), with([](SceneOptions& o) { o.max_side_px = 32; }));
  ASSERT_TRUE(bounded);
  EXPECT_EQ(bounded->pictures[0].camera.width_px, 32);
  EXPECT_EQ(bounded->pictures[0].camera.height_px, 24);
}

TEST(ReadScene, ReadsItsPointsAndUndistorts) {
  const test::TempDir folder;
  ASSERT_TRUE(io::save_image(folder / "a.png", sensor::ImageRgb8(60, 40, 200)));
  ASSERT_TRUE(io::write_points_ply(folder / "p.ply", {{{1, 2, 3}}, {{9, 8, 7}}}));
  folder.write("transforms.json", R"({"fl_x": 40, "w": 60, "h": 40, "k1": -0.2, "ply_file_path": "p.ply",
      "frames": [{"file_path": "a.png", "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]}]})");
  const auto scene = read_scene(folder / "transforms.json", {});
  ASSERT_TRUE(scene) << scene.error().context;
  EXPECT_EQ(scene->points.points_m[0], Eigen::Vector3f(1, 2, 3));
  const ScenePicture& picture = scene->pictures[0];
  EXPECT_EQ(picture.camera.distortion[0], 0.0);
  // A barrel picture holds more than the pinhole shows: everything is seen. The other way round corners are
  // empty.
  EXPECT_EQ(picture.picture.pixel(0, 0)[0], 200);
  folder.write("transforms.json", R"({"fl_x": 40, "w": 60, "h": 40, "k1": 0.2,
      "frames": [{"file_path": "a.png", "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]}]})");
  const auto pillow = read_scene(folder.path(), {});
  ASSERT_TRUE(pillow) << pillow.error().context;
  ASSERT_EQ(pillow->pictures[0].weight.size(), 60U * 40U);
  EXPECT_EQ(pillow->pictures[0].weight[0], 0.0F);
  EXPECT_EQ(pillow->pictures[0].weight[20 * 60 + 30], 1.0F);
}

TEST(ReadScene, ReadsDepthAndUndistortsIt) {
  const test::TempDir folder;
  ASSERT_TRUE(io::save_image(folder / "a.png", sensor::ImageRgb8(60, 40, 200)));
  sensor::ImageGray16 depth_mm(60, 40);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) *depth_mm.pixel(x, y) = static_cast<std::uint16_t>(1000 + 10 * x);
  }
  ASSERT_TRUE(io::save_image(folder / "d.png", depth_mm));
  const auto write = [&folder](const std::string& k1) {
    folder.write("transforms.json", R"({"fl_x": 40, "w": 60, "h": 40, "k1": )" + k1 + R"(, "frames": [
      {"file_path": "a.png", "depth_file_path": "d.png", "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]}]})");
  };
  write("0");
  const auto straight = read_scene(folder.path(), {});
  ASSERT_TRUE(straight) << straight.error().context;
  ASSERT_EQ(straight->pictures[0].depth_m.size(), 60U * 40U);
  EXPECT_NEAR(straight->pictures[0].depth_m[20 * 60 + 50], 1.5F, 1e-4F);
  write("0.2");  // pixel 50 of the pinhole was seen farther out, the corner not at all
  const auto pillow = read_scene(folder.path(), {});
  ASSERT_TRUE(pillow) << pillow.error().context;
  const double x = (50.0 - 29.5) / 40.0, y = (20.0 - 19.5) / 40.0;
  const double seen_at = 29.5 + 40.0 * x * (1.0 + 0.2 * (x * x + y * y));
  EXPECT_NEAR(pillow->pictures[0].depth_m[20 * 60 + 50], 1.0 + 0.01 * std::round(seen_at), 1e-4);
  EXPECT_EQ(pillow->pictures[0].depth_m[0], 0.0F);
  EXPECT_TRUE(
      read_scene(folder.path(), with([](SceneOptions& o) { o.depth = false; }))->pictures[0].depth_m.empty());
  ASSERT_TRUE(io::save_image(folder / "d.png", sensor::ImageGray16(30, 30)));
  EXPECT_THAT(read_scene(folder.path(), {}).error().context, HasSubstr("d.png"));
  ASSERT_TRUE(io::save_image(folder / "d.png", sensor::ImageRgb8(60, 40)));
  EXPECT_THAT(read_scene(folder.path(), {}).error().context, HasSubstr("d.png"));
  std::filesystem::remove(folder / "d.png");
  EXPECT_TRUE(read_scene(folder.path(), {}).value().pictures[0].depth_m.empty());
}

TEST(ReadScene, DepthPicturesMayBeSmallerAndHaveAnotherUnit) {
  const test::TempDir folder;
  ASSERT_TRUE(io::save_image(folder / "a.png", sensor::ImageRgb8(60, 40, 200)));
  sensor::ImageGray16 depth(30, 20);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 30; ++x) *depth.pixel(x, y) = static_cast<std::uint16_t>(5000 + 100 * x);
  }
  ASSERT_TRUE(io::save_image(folder / "d.png", depth));
  folder.write("transforms.json", R"({"fl_x": 40, "w": 60, "h": 40, "frames": [
      {"file_path": "a.png", "depth_file_path": "d.png", "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]}]})");
  const auto scene = read_scene(
      folder.path(), with([](SceneOptions& o) { o.depth_unit_m = 2e-4; }));  // as TUM's RGB-D sequences
  ASSERT_TRUE(scene) << scene.error().context;
  const std::vector<float>& depth_m = scene->pictures[0].depth_m;
  ASSERT_EQ(depth_m.size(), 60U * 40U);
  for (const int x : {0, 1, 30, 59}) {  // pixels 2 k and 2 k + 1 lie in pixel k
    EXPECT_NEAR(depth_m[20 * 60 + static_cast<std::size_t>(x)], 1.0 + 0.02 * (x / 2), 1e-5) << x;
  }
}

TEST(ReadScene, ThirdRadialTermIsUndistorted) {
  const test::TempDir folder;
  ASSERT_TRUE(io::save_image(folder / "a.png", sensor::ImageRgb8(60, 40, 200)));
  folder.write("transforms.json", R"({"fl_x": 40, "w": 60, "h": 40, "k3": 0.2,
      "frames": [{"file_path": "a.png", "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]}]})");
  const auto scene = read_scene(folder.path(), {});
  ASSERT_TRUE(scene) << scene.error().context;
  EXPECT_FALSE(scene->pictures[0].camera.has_distortion());
  ASSERT_EQ(scene->pictures[0].weight.size(), 60U * 40U);
  EXPECT_EQ(scene->pictures[0].weight[0], 0.0F) << "a pincushion's corner was not seen";
}

void expect_same(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.images_missing, b.images_missing);
  EXPECT_EQ(a.points.points_m, b.points.points_m);
  EXPECT_EQ(a.points.rgb, b.points.rgb);
  ASSERT_EQ(a.pictures.size(), b.pictures.size());
  for (std::size_t i = 0; i < a.pictures.size(); ++i) {
    EXPECT_EQ(a.pictures[i].name, b.pictures[i].name);
    EXPECT_EQ(a.pictures[i].picture.values, b.pictures[i].picture.values);
    EXPECT_EQ(a.pictures[i].camera, b.pictures[i].camera);
    EXPECT_TRUE(
        a.pictures[i].map_from_camera.matrix().isApprox(b.pictures[i].map_from_camera.matrix(), 1e-9));
  }
}

TEST(ReadScene, ColmapsFormsGiveTheSameAsNerfstudios) {
  const test::TempDir folder;
  write_wall_scene(folder, 5, 64, 48);
  std::filesystem::remove(folder / "images" / "view3.png");
  const auto nerf = read_scene(folder.path(), {});
  ASSERT_TRUE(nerf) << nerf.error().context;
  io::ColmapSample sample = colmap_of(folder.path());
  std::filesystem::remove(folder / "transforms.json");
  EXPECT_EQ(read_scene(folder.path(), {}).error().code, Errc::kNotFound);
  sample.write_txt(folder, "colmap/sparse/0");
  for (const char* scene : {"", "colmap/sparse/0/"}) {  // there the images lie two folders up and one more
    const auto text =
        read_scene(folder / scene, with([&](SceneOptions& o) { o.images = folder / "images"; }));
    ASSERT_TRUE(text) << text.error().context;
    expect_same(*nerf, *text);
  }
  sample.points = {{{1, 2, 3}, {4, 5, 6}}, {{7, 8, 9}, {10, 11, 12}}};
  sample.write_bin(folder, "sparse/0");
  for (const char* scene : {"", "sparse/0", "sparse/0/"}) {
    const auto binary = read_scene(folder / scene, {});
    ASSERT_TRUE(binary) << binary.error().context;
    Scene expected = *nerf;
    expected.points = sample.points;
    expect_same(expected, *binary);
  }
  std::filesystem::remove(folder / "sparse/0/points3D.bin");  // as 3DGS leaves it beside or instead
  ASSERT_TRUE(io::write_points_ply(folder / "sparse/0/points3D.ply", {{{5, 6, 7}}, {{1, 1, 1}}}));
  EXPECT_EQ(read_scene(folder.path(), {})->points.points_m[0], Eigen::Vector3f(5, 6, 7));
}

TEST(ReadScene, ColmapImagesOfHalfTheSizeAreTakenAsTheyAre) {
  const test::TempDir folder;
  write_wall_scene(folder, 3, 64, 48);
  colmap_of(folder.path()).write_bin(folder, "sparse/0");
  std::filesystem::remove(folder / "transforms.json");
  std::filesystem::create_directories(folder / "images_2");
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(io::save_image(folder / ("images_2/view" + std::to_string(i) + ".png"),
                               WallScene::shoot(i, 32, 24).picture));
  }
  const auto scene =
      read_scene(folder.path(), with([&](SceneOptions& o) { o.images = folder / "images_2"; }));
  ASSERT_TRUE(scene) << scene.error().context;
  EXPECT_EQ(scene->pictures[1].picture.values, WallScene::shoot(1, 32, 24).picture.values);
  EXPECT_NEAR(scene->pictures[1].camera.fx_px, WallScene::camera(32, 24).fx_px, 1e-9);
  EXPECT_NEAR(scene->pictures[1].camera.cx_px, WallScene::camera(32, 24).cx_px, 1e-9);
  ASSERT_TRUE(io::save_image(folder / "images_2/view1.png", sensor::ImageRgb8(30, 30)));
  EXPECT_THAT(read_scene(folder.path(), with([&](SceneOptions& o) { o.images = folder / "images_2"; }))
                  .error()
                  .context,
              HasSubstr("view1.png is 30x30, its camera 64x48"));
  EXPECT_THAT(read_scene(folder.path(), with([&](SceneOptions& o) { o.images = folder / "images_8"; }))
                  .error()
                  .context,
              HasSubstr("images_8/view0.png"));
}

TEST(ReadScene, SaysWhatIsWrong) {
  const test::TempDir folder;
  EXPECT_EQ(read_scene(folder / "nowhere", {}).error().code, Errc::kNotFound);
  EXPECT_EQ(read_scene(folder.path(), {}).error().code, Errc::kNotFound);
  EXPECT_THAT(read_scene(folder.path(), {}).error().context,
              AllOf(HasSubstr("transforms.json"), HasSubstr("sparse/0")));
  write_wall_scene(folder, 2, 32, 24);
  ASSERT_TRUE(io::save_image(folder / "images" / "view0.png", sensor::ImageRgb8(10, 10)));
  EXPECT_THAT(read_scene(folder.path(), {}).error().context,
              HasSubstr("view0.png is 10x10, its camera 32x24"));
  std::filesystem::remove_all(folder / "images");
  EXPECT_THAT(read_scene(folder.path(), {}).error().context, HasSubstr("none of the 2 images"));
}

TEST(Triangulate, FindsTheWall) {
  std::vector<ScenePicture> shots;
  shots.reserve(5);
  for (int i = 0; i < 5; ++i) shots.push_back(WallScene::shoot(i, 320, 240));
  const auto cloud = triangulate(pointers(shots));
  ASSERT_TRUE(cloud) << cloud.error().context;
  ASSERT_GT(cloud->points_m.size(), 200U);
  ASSERT_EQ(cloud->rgb.size(), cloud->points_m.size());
  std::size_t near = 0, right_colour = 0;
  for (std::size_t i = 0; i < cloud->points_m.size(); ++i) {
    const Eigen::Vector3f& p = cloud->points_m[i];
    near += std::abs(p.z()) < 0.05F ? 1U : 0U;  // half a pixel for the nearest pair
    const auto truth = WallScene::colour(static_cast<double>(p.x()), static_cast<double>(p.y()));
    right_colour += std::abs(255.0F * truth[0] - static_cast<float>(cloud->rgb[i][0])) < 30.0F ? 1U : 0U;
  }
  EXPECT_GT(near, cloud->points_m.size() * 95 / 100);
  EXPECT_GT(right_colour, cloud->points_m.size() * 9 / 10);
}

TEST(Triangulate, PicturesOfNothingGiveNoPoints) {
  const ScenePicture blank{"a", WallScene::camera(64, 48), WallScene::pose(0), {64, 48}, {}, {}};
  ScenePicture other = blank;
  other.map_from_camera = WallScene::pose(3);
  EXPECT_TRUE(triangulate(pointers({blank, other})).value().points_m.empty());
  EXPECT_TRUE(triangulate({}).value().points_m.empty());
}

TEST(GaussiansOfPoints, AreAsWideAsTheirNeighboursAreFar) {
  io::PointCloud points;
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y)
      points.points_m.emplace_back(0.01F * static_cast<float>(x), 0.01F * static_cast<float>(y), 0.0F);
  }
  points.points_m.emplace_back(3.0F, 0.0F, 0.0F);  // far from all others
  points.rgb.assign(points.points_m.size(), {255, 128, 0});
  mapping::IdAllocator ids(1);
  const auto cloud = gaussians_of_points(points, {5.0, 1000}, ids);
  ASSERT_TRUE(cloud.consistent());
  ASSERT_EQ(cloud.size(), 65U);
  EXPECT_NEAR(cloud.log_scales[3 * 27], std::log(0.01F), 1e-3F);  // in the middle: all three at 1 cm
  EXPECT_NEAR(cloud.log_scales[3 * 64], std::log(5.0F / 16.0F), 1e-3F);
  EXPECT_NEAR(0.5F + gaussian::GaussianCloud::kShC0 * cloud.sh[0], 1.0F, 1e-5F);
  EXPECT_NEAR(cloud.opacity_logits[0], std::log(1.0F / 9.0F), 1e-4F);
  EXPECT_LE(gaussians_of_points(points, {5.0, 20}, ids).size(), 20U);
}

}  // namespace
}  // namespace edgesplat::desk
