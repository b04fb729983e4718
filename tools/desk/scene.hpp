// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/io/ply_points.hpp"
#include "common/sensor/image.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace edgesplat::desk {

/// A picture of a scene, as a pinhole without distortion would have taken it.
struct ScenePicture {
  std::string name;
  geometry::CameraModel camera;
  geometry::RigidTransform map_from_camera;
  sensor::ImageRgb8 picture;
  std::vector<float> weight;   ///< [H,W] 0 where undistorting found nothing, else 1; empty: 1 everywhere
  std::vector<float> depth_m;  ///< [H,W] along z, 0: not measured; empty: the scene has none of this view
};

/// A scene to train a map on, from a folder of nerfstudio's or COLMAP's (scene_files.hpp).
struct Scene {
  std::vector<ScenePicture> pictures;  ///< in the order of nerfstudio's file; COLMAP's by their names
  io::PointCloud points;               ///< ply_file_path, or points3D; empty where there is none
  std::size_t images_missing = 0;      ///< frames of the scene without an image: left out
};

struct SceneOptions {
  /// Pictures become this much smaller, 1..32; 0: as little as brings the longer side to at most
  /// `max_side_px`.
  double downscale = 0.0;
  int max_side_px = 640;
  std::filesystem::path images;  ///< of a scene of COLMAP's; empty: where find_scene_files() finds them
  bool depth = true;             ///< read depth pictures where the scene names some
  double depth_unit_m = 1e-3;    ///< of their values
};

/// `folder`: as find_scene_files() takes it. Errors: kNotFound (no such folder, no image at all), kCorrupt
/// with the file's name.
[[nodiscard]] Result<Scene> read_scene(const std::filesystem::path& folder, const SceneOptions& options);

/// 1.1 times the largest distance of a camera from the cameras' centre, as 3DGS measures a scene; at least
/// 1e-6.
[[nodiscard]] double camera_extent(std::span<const ScenePicture* const> pictures);

}  // namespace edgesplat::desk
