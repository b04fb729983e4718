// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/colmap_model.hpp"

#include "common/io/image_file.hpp"
#include "test/common/io/colmap_samples.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <random>

namespace edgesplat::io {
namespace {

using geometry::CameraKind;
using geometry::CameraModel;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::span<const std::byte> as_bytes(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

/// One camera through both forms, which must agree; what the parser says otherwise.
Result<CameraModel> read_one(std::int32_t model, const std::string& name, std::vector<double> parameters) {
  ColmapSample sample;
  sample.cameras = {{5, model, name, 640, 480, std::move(parameters)}};
  const auto binary = parse_colmap_cameras(sample.cameras_bin(), ColmapForm::kBinary);
  const auto text = parse_colmap_cameras(as_bytes(sample.cameras_txt()), ColmapForm::kText);
  EXPECT_EQ(binary.has_value(), text.has_value());
  if (!binary) return tl::unexpected(binary.error());
  EXPECT_EQ(binary->at(5), text->at(5));
  return binary->at(5);
}

CameraModel camera(CameraKind kind, double fx, double fy, std::array<double, 4> distortion, double k3 = 0.0) {
  return {kind, 640, 480, fx, fy, 319.5, 239.5, distortion, k3};
}

TEST(ColmapCameras, HaveTheirParametersInTheirPlaces) {
  const auto kPinhole = CameraKind::kPinhole, kFisheye = CameraKind::kFisheye;
  EXPECT_EQ(read_one(0, "SIMPLE_PINHOLE", {500, 320, 240}), camera(kPinhole, 500, 500, {}));
  EXPECT_EQ(read_one(1, "PINHOLE", {500, 510, 320, 240}), camera(kPinhole, 500, 510, {}));
  EXPECT_EQ(read_one(2, "SIMPLE_RADIAL", {500, 320, 240, 0.1}), camera(kPinhole, 500, 500, {0.1, 0, 0, 0}));
  EXPECT_EQ(read_one(3, "RADIAL", {500, 320, 240, 0.1, 0.2}), camera(kPinhole, 500, 500, {0.1, 0.2, 0, 0}));
  EXPECT_EQ(read_one(4, "OPENCV", {500, 510, 320, 240, 0.1, 0.2, 0.3, 0.4}),
            camera(kPinhole, 500, 510, {0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(read_one(5, "OPENCV_FISHEYE", {500, 510, 320, 240, 0.1, 0.2, 0.3, 0.4}),
            camera(kFisheye, 500, 510, {0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(read_one(6, "FULL_OPENCV", {500, 510, 320, 240, 0.1, 0.2, 0.3, 0.4, 0.5, 0, 0, 0}),
            camera(kPinhole, 500, 510, {0.1, 0.2, 0.3, 0.4}, 0.5));
  EXPECT_EQ(read_one(8, "SIMPLE_RADIAL_FISHEYE", {500, 320, 240, 0.1}),
            camera(kFisheye, 500, 500, {0.1, 0, 0, 0}));
  EXPECT_EQ(read_one(9, "RADIAL_FISHEYE", {500, 320, 240, 0.1, 0.2}),
            camera(kFisheye, 500, 500, {0.1, 0.2, 0, 0}));
  EXPECT_EQ(read_one(14, "SIMPLE_FISHEYE", {500, 320, 240}), camera(kFisheye, 500, 500, {}));
  EXPECT_EQ(read_one(15, "FISHEYE", {500, 510, 320, 240}), camera(kFisheye, 500, 510, {}));
}

TEST(ColmapCameras, SayWhatToDoAboutOtherModels) {
  const auto refusal = [](auto... all) { return read_one(all...).error().context; };
  EXPECT_THAT(refusal(6, "FULL_OPENCV", std::vector<double>{500, 510, 320, 240, 0, 0, 0, 0, 0, 0, 0.1, 0}),
              AllOf(HasSubstr("camera 5"), HasSubstr("k4, k5 or k6"), HasSubstr("image_undistorter")));
  EXPECT_THAT(refusal(7, "FOV", std::vector<double>{500, 510, 320, 240, 0.9}),
              HasSubstr("image_undistorter"));
  EXPECT_THAT(refusal(10, "THIN_PRISM_FISHEYE", std::vector<double>(12, 1.0)), HasSubstr("undistort"));
  EXPECT_THAT(refusal(1, "PINHOLE", std::vector<double>{-500, 510, 320, 240}), HasSubstr("focal lengths"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(1, "PINHOLE", std::vector<double>{500, nan, 320, 240}), HasSubstr("not finite"));
}

/// The images of the sample, which both forms must give.
void expect_sample_images(const Result<std::vector<PosedCamera>>& images) {
  ASSERT_TRUE(images) << images.error().context;
  ASSERT_EQ(images->size(), 3U);
  EXPECT_EQ((*images)[0].image, "a/left.png");  // by name
  EXPECT_EQ((*images)[1].image, "b.png");
  EXPECT_EQ((*images)[2].image, "c.png");
  EXPECT_EQ((*images)[0].camera.width_px, 40);
  EXPECT_EQ((*images)[1].camera.width_px, 64);
  EXPECT_EQ((*images)[1].camera.cx_px, 31.75);
  EXPECT_TRUE(
      (*images)[1].map_from_camera.matrix().isApprox(geometry::RigidTransform::identity().matrix(), 1e-12));
  // p_in_camera = R p + t with R z = x, R x = -z: the origin of the map lies at (1, 2, 3) of the camera.
  const geometry::RigidTransform& pose = (*images)[0].map_from_camera;
  EXPECT_TRUE((pose * Eigen::Vector3d(1, 2, 3)).isZero(1e-12));
  EXPECT_TRUE((pose * Eigen::Vector3d(2, 2, 3)).isApprox(Eigen::Vector3d(0, 0, 1), 1e-12));
  EXPECT_TRUE((pose * Eigen::Vector3d(1, 2, 4)).isApprox(Eigen::Vector3d(-1, 0, 0), 1e-12));
}

TEST(ColmapImages, ComeByNameWithTheirPoses) {
  const ColmapSample sample = colmap_sample();
  const auto cameras = parse_colmap_cameras(sample.cameras_bin(), ColmapForm::kBinary).value();
  expect_sample_images(parse_colmap_images(sample.images_bin(), ColmapForm::kBinary, cameras));
  expect_sample_images(parse_colmap_images(as_bytes(sample.images_txt()), ColmapForm::kText, cameras));
}

TEST(ColmapImages, TextMayHaveBlanksInNamesAndNoLineAtTheEnd) {
  const auto cameras = parse_colmap_cameras(colmap_sample().cameras_bin(), ColmapForm::kBinary).value();
  const auto images = parse_colmap_images(
      as_bytes("1 1 0 0 0 0 0 0 7 my photo.jpg\r\n\r\n2 1 0 0 0 0 0 0 7  b.jpg \n1 2 -1 3 4 -1"),
      ColmapForm::kText, cameras);
  ASSERT_TRUE(images) << images.error().context;
  ASSERT_EQ(images->size(), 2U);
  EXPECT_EQ((*images)[0].image, "b.jpg");
  EXPECT_EQ((*images)[1].image, "my photo.jpg");
}

TEST(ColmapPoints, ComeWithTheirColours) {
  const ColmapSample sample = colmap_sample();
  for (const auto& cloud : {parse_colmap_points(sample.points_bin(), ColmapForm::kBinary),
                            parse_colmap_points(as_bytes(sample.points_txt()), ColmapForm::kText)}) {
    ASSERT_TRUE(cloud) << cloud.error().context;
    EXPECT_EQ(cloud->points_m, sample.points.points_m);
    EXPECT_EQ(cloud->rgb, sample.points.rgb);
  }
}

TEST(ColmapPoints, ThatAreNotFiniteAreLeftOut) {
  ColmapSample sample = colmap_sample();
  sample.points.points_m[1].y() = std::numeric_limits<float>::quiet_NaN();
  sample.points.points_m[2].z() = std::numeric_limits<float>::infinity();
  const auto cloud = parse_colmap_points(sample.points_bin(), ColmapForm::kBinary);
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->points_m.size(), 2U);
  EXPECT_THAT(cloud->rgb, ElementsAre(sample.points.rgb[0], sample.points.rgb[3]));
  EXPECT_EQ(parse_colmap_points(as_bytes(sample.points_txt()), ColmapForm::kText)->points_m.size(), 2U);
}

TEST(ReadColmap, FindsItsFilesAndScalesCamerasToTheirImages) {
  const test::TempDir folder;
  EXPECT_FALSE(find_colmap_model(folder.path()));
  const ColmapSample sample = colmap_sample();
  sample.write_txt(folder, "sparse");
  EXPECT_EQ(find_colmap_model(folder.path()), folder / "sparse");
  sample.write_bin(folder, "sparse/0");
  EXPECT_EQ(find_colmap_model(folder.path()), folder / "sparse/0");
  EXPECT_TRUE(find_colmap_model(folder / "sparse/0"));
  std::filesystem::create_directories(folder / "images_2" / "a");
  ASSERT_TRUE(save_image(folder / "images_2/b.png", sensor::ImageRgb8(32, 24)));
  ASSERT_TRUE(save_image(folder / "images_2/a/left.png", sensor::ImageRgb8(30, 30)));  // another shape
  const auto set = read_colmap(folder / "sparse/0", folder / "images_2");
  ASSERT_TRUE(set) << set.error().context;
  ASSERT_EQ(set->cameras.size(), 3U);
  EXPECT_EQ(set->cameras[0].name, "left");
  EXPECT_EQ(set->cameras[0].camera.width_px, 40) << "not the same view: whoever reads it is to complain";
  EXPECT_EQ(set->cameras[1].camera.width_px, 32);
  EXPECT_DOUBLE_EQ(set->cameras[1].camera.fx_px, 25.0);
  EXPECT_DOUBLE_EQ(set->cameras[1].camera.cx_px, 32.25 / 2 - 0.5);
  EXPECT_EQ(set->cameras[2].camera.width_px, 64) << "its image is missing";
  EXPECT_EQ(set->points, folder / "sparse/0/points3D.bin");
  EXPECT_EQ(read_points(set->points)->points_m, sample.points.points_m);
  EXPECT_EQ(read_points(folder / "sparse/points3D.txt")->rgb, sample.points.rgb);
}

TEST(ReadColmap, NamesTheFileThatIsWrong) {
  const test::TempDir folder;
  ColmapSample sample = colmap_sample();
  sample.images[1].camera = 8;
  sample.write_bin(folder, "sparse/0");
  EXPECT_THAT(read_colmap(folder / "sparse/0", folder.path()).error().context,
              AllOf(HasSubstr("images.bin"), HasSubstr("a/left.png"), HasSubstr("no camera 8")));
  sample.images.clear();
  sample.write_bin(folder, "sparse/0");
  EXPECT_THAT(read_colmap(folder / "sparse/0", folder.path()).error().context, HasSubstr("names no image"));
  folder.write("sparse/0/cameras.bin", std::string_view("12"));
  EXPECT_THAT(read_colmap(folder / "sparse/0", folder.path()).error().context, HasSubstr("cameras.bin: "));
  EXPECT_EQ(read_colmap(folder / "none", folder.path()).error().code, Errc::kNotFound);
}

/// Every length, absurd counts and random damage: an error or a model, whatever comes.
template <typename Parse>
void survive(const std::vector<std::byte>& good, Parse parse) {
  ASSERT_TRUE(parse(good));
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_FALSE(parse(std::span(good).first(length))) << length;
  std::mt19937 random(3);
  for (int round = 0; round < 5000; ++round) {
    auto damaged = good;
    for (int i = 0; i < 3; ++i) damaged[random() % damaged.size()] = static_cast<std::byte>(random());
    (void)parse(damaged);
  }
  for (const std::uint64_t count : {std::uint64_t{5}, std::uint64_t{1} << 40U, ~std::uint64_t{0}}) {
    auto absurd = good;
    std::memcpy(absurd.data(), &count, sizeof(count));
    EXPECT_FALSE(parse(absurd)) << count;
  }
}

TEST(ColmapHostile, BinaryDamageIsSurvived) {
  const ColmapSample sample = colmap_sample();
  const auto cameras = parse_colmap_cameras(sample.cameras_bin(), ColmapForm::kBinary).value();
  survive(sample.cameras_bin(),
          [](std::span<const std::byte> bytes) { return parse_colmap_cameras(bytes, ColmapForm::kBinary); });
  survive(sample.images_bin(), [&cameras](std::span<const std::byte> bytes) {
    return parse_colmap_images(bytes, ColmapForm::kBinary, cameras);
  });
  survive(sample.points_bin(),
          [](std::span<const std::byte> bytes) { return parse_colmap_points(bytes, ColmapForm::kBinary); });
}

TEST(ColmapHostile, InnerCountsAndPosesThatAreNone) {
  ColmapSample sample = colmap_sample();
  const auto cameras = parse_colmap_cameras(sample.cameras_bin(), ColmapForm::kBinary).value();
  sample.images.resize(1);
  sample.images[0].features = 0;
  auto bytes = sample.images_bin();
  const std::uint64_t absurd = (std::uint64_t{1} << 61U) + 1;  // times 24 it is small
  std::memcpy(bytes.data() + bytes.size() - 8, &absurd, 8);
  EXPECT_FALSE(parse_colmap_images(bytes, ColmapForm::kBinary, cameras));
  sample.images[0].camera_from_map.rotation.coeffs().setZero();
  EXPECT_THAT(parse_colmap_images(sample.images_bin(), ColmapForm::kBinary, cameras).error().context,
              HasSubstr("no rotation"));
  sample = colmap_sample();
  sample.images[0].camera_from_map.translation_m.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(parse_colmap_images(as_bytes(sample.images_txt()), ColmapForm::kText, cameras));
  sample.cameras[1].id = sample.cameras[0].id;
  EXPECT_THAT(parse_colmap_cameras(sample.cameras_bin(), ColmapForm::kBinary).error().context,
              HasSubstr("two of it"));
}

TEST(ColmapHostile, TextDamageIsSurvivedAndTold) {
  const ColmapSample sample = colmap_sample();
  const auto cameras = parse_colmap_cameras(sample.cameras_bin(), ColmapForm::kBinary).value();
  std::mt19937 random(4);
  for (int round = 0; round < 5000; ++round) {
    for (std::string text : {sample.cameras_txt(), sample.images_txt(), sample.points_txt()}) {
      for (int i = 0; i < 3; ++i) text[random() % text.size()] = static_cast<char>(random());
      (void)parse_colmap_cameras(as_bytes(text), ColmapForm::kText);
      (void)parse_colmap_images(as_bytes(text), ColmapForm::kText, cameras);
      (void)parse_colmap_points(as_bytes(text), ColmapForm::kText);
    }
  }
  EXPECT_THAT(parse_colmap_cameras(as_bytes("# c\n1 PINHOLE 4 4 1 1 1"), ColmapForm::kText).error().context,
              HasSubstr("line 2"));
  EXPECT_FALSE(parse_colmap_cameras(as_bytes("1 PINHOLE 4 4 1 1 1 1 1"), ColmapForm::kText));
  // Without lines for features every second image would be taken for one.
  EXPECT_THAT(parse_colmap_images(as_bytes("1 1 0 0 0 0 0 0 7 a.png\n2 1 0 0 0 0 0 0 7 b.png\n"),
                                  ColmapForm::kText, cameras)
                  .error()
                  .context,
              AllOf(HasSubstr("line 2"), HasSubstr("features")));
  EXPECT_THAT(parse_colmap_points(as_bytes("1 0 0 0 256 0 0 1"), ColmapForm::kText).error().context,
              HasSubstr("line 1"));
}

}  // namespace
}  // namespace edgesplat::io
