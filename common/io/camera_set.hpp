// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::io {

struct PosedCamera {
  std::string name;             ///< unique in its set; fit for a file's name
  std::filesystem::path image;  ///< relative to the set's file; empty where there is none
  geometry::CameraModel camera;
  geometry::RigidTransform map_from_camera;
  /// 16-bit PNG of the same view, mm along the camera's z; relative as well, empty where there is none
  std::filesystem::path depth;
};

struct CameraSet {
  std::vector<PosedCamera> cameras;  ///< in the order of the file
  std::filesystem::path points;      ///< point cloud of the scene, relative to the set's file; may be empty
};

/// Two forms, told apart by their keys:
///
/// * {"cameras": [{"name": "front", "width": 640, "height": 480, "fx": 500, "fy": 500, "cx": 319.5, "cy":
/// 239.5,
///   "model": "pinhole" or "fisheye", "distortion": [k1, k2, p1, p2] or [k1, k2, p1, p2, k3] (fisheye: [k1,
///   k2, k3, k4]), "image": "front.jpg",
///   "map_from_camera": 3 or 4 rows of 4}]}: the axes and pixel centres of geometry::CameraModel; name,
///   model, distortion and image may be absent.
/// * {"frames": [{"file_path": ..., "transform_matrix": ...}]}: nerfstudio's transforms.json. Its cameras
/// look
///   along -z with y up and have pixel centres at 0.5: both are converted. A frame may name a
///   depth_file_path. Intrinsics (fl_x, fl_y, cx, cy, w, h, k1, k2, k3, p1, p2, camera_model, or
///   camera_angle_x) of a frame go before those of the file.
///
/// kCorrupt names the camera and what is wrong with it. A size that the file does not state is left at 0.
[[nodiscard]] Result<CameraSet> parse_camera_set(std::string_view text);
/// The same of a file; sizes that are missing come from the images' headers.
[[nodiscard]] Result<CameraSet> read_camera_set(const std::filesystem::path& path);

/// Where a camera's image lies: beside `set_file`, with .png or .jpg added where the name has no ending (as
/// in NeRF's synthetic scenes). Nothing is opened; the path may not exist.
[[nodiscard]] std::filesystem::path image_path(const std::filesystem::path& set_file,
                                               const PosedCamera& camera);

}  // namespace edgesplat::io
