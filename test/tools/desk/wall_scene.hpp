// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/so3.hpp"
#include "common/io/image_file.hpp"
#include "test/support/temp_dir.hpp"
#include "tools/desk/scene.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace edgesplat::desk {

/// A wall in the plane z = 0 of the scene with a smooth random pattern: what a camera in front of it sees is
/// known exactly.
struct WallScene {
  static constexpr double kCell_m = 0.1;  ///< of the pattern

  static float noise(std::int64_t column, std::int64_t row, std::uint64_t channel) {
    std::uint64_t h = static_cast<std::uint64_t>(column) * 0x9E3779B97F4A7C15ULL +
                      static_cast<std::uint64_t>(row) * 0xC2B2AE3D27D4EB4FULL +
                      channel * 0x165667B19E3779F9ULL;
    h = (h ^ (h >> 31U)) * 0x7FB5D329728EA185ULL;
    h = (h ^ (h >> 27U)) * 0x81DADEF4BC2DD44DULL;
    return static_cast<float>((h ^ (h >> 33U)) & 0xFFFFU) / 65535.0F;
  }
  static std::array<float, 3> colour(double x_m, double y_m) {
    const double u = x_m / kCell_m, v = y_m / kCell_m;
    const auto column = static_cast<std::int64_t>(std::floor(u)),
               row = static_cast<std::int64_t>(std::floor(v));
    const auto fx = static_cast<float>(u - std::floor(u)), fy = static_cast<float>(v - std::floor(v));
    std::array<float, 3> out{};
    for (std::uint64_t c = 0; c < 3; ++c) {
      const float top = noise(column, row, c) * (1 - fx) + noise(column + 1, row, c) * fx;
      const float bottom = noise(column, row + 1, c) * (1 - fx) + noise(column + 1, row + 1, c) * fx;
      out[c] = top * (1 - fy) + bottom * fy;
    }
    // Mostly grey, as walls are.
    return {0.8F * out[1] + 0.2F * out[0], out[1], 0.8F * out[1] + 0.2F * out[2]};
  }

  static geometry::CameraModel camera(int width_px, int height_px) {
    geometry::CameraModel out;
    out.width_px = width_px;
    out.height_px = height_px;
    out.fx_px = out.fy_px = width_px;
    out.cx_px = 0.5 * (width_px - 1);
    out.cy_px = 0.5 * (height_px - 1);
    return out;
  }
  /// 2 m before the wall, turning a little; number 0 in the middle of the others.
  static geometry::RigidTransform pose(int i) {
    geometry::RigidTransform out;
    out.rotation = geometry::so3_exp({0.05 * std::sin(i), 0.1 * std::cos(i), 0.02 * i});
    const double radius_m = 0.15 * std::sqrt(5 * i % 9);
    out.translation_m = {radius_m * std::cos(2.4 * i), radius_m * std::sin(2.4 * i), -2.0};
    return out;
  }
  static ScenePicture shoot(int i, int width_px, int height_px) {
    ScenePicture out{
        "view" + std::to_string(i), camera(width_px, height_px), pose(i), {width_px, height_px}, {}, {}};
    for (int y = 0; y < height_px; ++y) {
      for (int x = 0; x < width_px; ++x) {
        const Eigen::Vector3d ray = out.map_from_camera.rotation * out.camera.unproject({x, y});
        const Eigen::Vector3d hit =
            out.map_from_camera.translation_m - ray * (out.map_from_camera.translation_m.z() / ray.z());
        const auto rgb = colour(hit.x(), hit.y());
        for (std::size_t c = 0; c < 3; ++c) {
          out.picture.pixel(x, y)[c] = static_cast<std::uint8_t>(std::lround(255.0F * rgb[c]));
        }
      }
    }
    return out;
  }
};

/// Writes pictures of the wall and a transforms.json in nerfstudio's conventions.
inline void write_wall_scene(const test::TempDir& folder, int count, int width_px, int height_px) {
  const auto model = WallScene::camera(width_px, height_px);
  nlohmann::json file = {{"fl_x", model.fx_px},     {"fl_y", model.fy_px}, {"cx", model.cx_px + 0.5},
                         {"cy", model.cy_px + 0.5}, {"w", width_px},       {"h", height_px}};
  std::filesystem::create_directories(folder / "images");
  for (int i = 0; i < count; ++i) {
    const ScenePicture shot = WallScene::shoot(i, width_px, height_px);
    const std::string name = "images/" + shot.name + ".png";
    ASSERT_TRUE(io::save_image(folder / name, shot.picture));
    Eigen::Matrix<double, 3, 4> rows = shot.map_from_camera.matrix();
    rows.middleCols<2>(1) *= -1.0;
    nlohmann::json matrix = nlohmann::json::array();
    for (int r = 0; r < 3; ++r) matrix.push_back({rows(r, 0), rows(r, 1), rows(r, 2), rows(r, 3)});
    file["frames"].push_back({{"file_path", name}, {"transform_matrix", matrix}});
  }
  folder.write("transforms.json", file.dump());
}

}  // namespace edgesplat::desk
