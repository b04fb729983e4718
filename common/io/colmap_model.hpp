// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/io/camera_set.hpp"
#include "common/io/ply_points.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <vector>

/// Reconstructions of COLMAP (cameras, images and points3D, as .bin or .txt), as other programs for Gaussian
/// maps take them. Source: https://colmap.github.io/format.html and COLMAP's camera models
/// (src/colmap/sensor/models.h). Pixel centres lie at 0.5 there, and a pose is camera_from_map: both are
/// converted.
namespace edgesplat::io {

enum class ColmapForm : std::uint8_t { kBinary, kText };

/// By COLMAP's number of the camera. SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV with
/// k4 = k5 = k6 = 0, OPENCV_FISHEYE, RADIAL_FISHEYE, SIMPLE_RADIAL_FISHEYE, FISHEYE and SIMPLE_FISHEYE.
/// kCorrupt names the camera and what is wrong with it; for other models it says what to do.
using ColmapCameras = std::map<std::uint32_t, geometry::CameraModel>;
[[nodiscard]] Result<ColmapCameras> parse_colmap_cameras(std::span<const std::byte> bytes, ColmapForm form);

/// The posed images in the order of their names; `image` is the name that COLMAP knows it by. The features in
/// them are skipped. kCorrupt for an unknown camera and for a pose that is none.
[[nodiscard]] Result<std::vector<PosedCamera>> parse_colmap_images(std::span<const std::byte> bytes,
                                                                   ColmapForm form,
                                                                   const ColmapCameras& cameras);

/// The triangulated points with their colours; those that are not finite are left out.
[[nodiscard]] Result<PointCloud> parse_colmap_points(std::span<const std::byte> bytes, ColmapForm form);

/// Where `folder` has a reconstruction: in sparse/0, sparse, colmap/sparse/0, colmap/sparse, or itself.
[[nodiscard]] std::optional<std::filesystem::path> find_colmap_model(const std::filesystem::path& folder);

/// The reconstruction that find_colmap_model() found. Paths in the set: `images` / NAME, and `model` /
/// points3D.{bin,txt,ply} where there is one, as they can be opened from here. An image that is larger or
/// smaller than its camera (images_2, images_4, ...) scales the camera. .bin goes before .txt. Errors:
/// kNotFound, kIo, kCorrupt with the file's name.
[[nodiscard]] Result<CameraSet> read_colmap(const std::filesystem::path& model,
                                            const std::filesystem::path& images);

/// A point cloud by its file's ending: .ply, or COLMAP's points3D.bin and points3D.txt.
[[nodiscard]] Result<PointCloud> read_points(const std::filesystem::path& path);

}  // namespace edgesplat::io
