// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/common/io/colmap_samples.hpp"

#include <fmt/format.h>

#include <numbers>

namespace edgesplat::io {
namespace {

std::array<double, 7> pose_values(const geometry::RigidTransform& camera_from_map) {
  const Eigen::Quaterniond& q = camera_from_map.rotation;
  const Eigen::Vector3d& t = camera_from_map.translation_m;
  return {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()};
}

}  // namespace

std::vector<std::byte> ColmapSample::cameras_bin() const {
  ByteWriter out;
  out.write(std::uint64_t{cameras.size()});
  for (const Camera& camera : cameras) {
    out.write(camera.id);
    out.write(camera.model);
    out.write(camera.width_px);
    out.write(camera.height_px);
    for (const double value : camera.parameters) out.write(value);
  }
  return out.take();
}

std::string ColmapSample::cameras_txt() const {
  std::string out =
      "# Camera list with one line of data per camera:\n#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n";
  for (const Camera& camera : cameras) {
    out += fmt::format("{} {} {} {}", camera.id, camera.model_name, camera.width_px, camera.height_px);
    for (const double value : camera.parameters) out += fmt::format(" {}", value);
    out += "\n";
  }
  return out;
}

std::vector<std::byte> ColmapSample::images_bin() const {
  ByteWriter out;
  out.write(std::uint64_t{images.size()});
  for (const Image& image : images) {
    out.write(image.id);
    for (const double value : pose_values(image.camera_from_map)) out.write(value);
    out.write(image.camera);
    out.write_text(image.name);
    out.write('\0');
    out.write(std::uint64_t{image.features});
    for (std::size_t i = 0; i < image.features; ++i) {
      out.write(10.5);
      out.write(20.5);
      out.write(std::int64_t{-1});
    }
  }
  return out.take();
}

std::string ColmapSample::images_txt() const {
  std::string out = "# Image list with two lines of data per image:\n";
  for (const Image& image : images) {
    out += fmt::format("{}", image.id);
    for (const double value : pose_values(image.camera_from_map)) out += fmt::format(" {}", value);
    out += fmt::format(" {} {}\n", image.camera, image.name);
    for (std::size_t i = 0; i < image.features; ++i) out += i == 0 ? "10.5 20.5 -1" : " 10.5 20.5 -1";
    out += "\n";
  }
  return out;
}

std::vector<std::byte> ColmapSample::points_bin() const {
  ByteWriter out;
  out.write(std::uint64_t{points.points_m.size()});
  for (std::size_t i = 0; i < points.points_m.size(); ++i) {
    out.write(std::uint64_t{i + 1});
    for (int axis = 0; axis < 3; ++axis) out.write(static_cast<double>(points.points_m[i][axis]));
    out.write_bytes(std::as_bytes(std::span(points.rgb[i])));
    out.write(0.25);
    out.write(std::uint64_t{i % 3});  // its track: images and features in them
    for (std::size_t k = 0; k < i % 3; ++k) out.write(std::uint64_t{1});
  }
  return out.take();
}

std::string ColmapSample::points_txt() const {
  std::string out = "# 3D point list with one line of data per point:\n";
  for (std::size_t i = 0; i < points.points_m.size(); ++i) {
    const Eigen::Vector3f& p = points.points_m[i];
    const auto& rgb = points.rgb[i];
    out += fmt::format("{} {} {} {} {} {} {} 0.25", i + 1, p.x(), p.y(), p.z(), rgb[0], rgb[1], rgb[2]);
    for (std::size_t k = 0; k < i % 3; ++k) out += " 1 0";
    out += "\n";
  }
  return out;
}

void ColmapSample::write_bin(const test::TempDir& folder, const std::string& model) const {
  folder.write(model + "/cameras.bin", cameras_bin());
  folder.write(model + "/images.bin", images_bin());
  folder.write(model + "/points3D.bin", points_bin());
}

void ColmapSample::write_txt(const test::TempDir& folder, const std::string& model) const {
  folder.write(model + "/cameras.txt", cameras_txt());
  folder.write(model + "/images.txt", images_txt());
  folder.write(model + "/points3D.txt", points_txt());
}

ColmapSample colmap_sample() {
  ColmapSample sample;
  sample.cameras = {{7, 4, "OPENCV", 64, 48, {50.0, 51.0, 32.25, 24.0, 0.1, -0.02, 0.003, -0.004}},
                    {9, 2, "SIMPLE_RADIAL", 40, 30, {45.0, 20.0, 15.0, -0.05}}};
  geometry::RigidTransform turned;  // a quarter about y: the camera looks along the map's -x
  turned.rotation = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY());
  turned.translation_m = {1.0, 2.0, 3.0};
  sample.images = {{3, geometry::RigidTransform::identity(), 7, "b.png", 2},
                   {1, turned, 9, "a/left.png", 0},
                   {2, turned, 7, "c.png", 1}};
  sample.points.points_m = {{1, 2, 3}, {-4, 5.5F, 6}, {0, 0, 1}, {9, 8, 7}};
  sample.points.rgb = {{1, 2, 3}, {255, 0, 128}, {9, 9, 9}, {0, 200, 255}};
  return sample;
}

}  // namespace edgesplat::io
