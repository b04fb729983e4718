// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/camera_set.hpp"
#include "common/io/image_file.hpp"
#include "common/io/json_fields.hpp"

#include <Eigen/Core>

#include <filesystem>
#include <string_view>
#include <vector>

/// What the forms of camera sets have in common. Inside common/io only.
namespace edgesplat::io {

using PoseRows = Eigen::Matrix<double, 3, 4>;

/// 3 or 4 rows of 4 numbers whose left part is a rotation, but for a common scale.
[[nodiscard]] Result<PoseRows> pose_rows(const json::Json& object, std::string_view key);
/// 0..16384; 0 where the key is absent.
[[nodiscard]] Result<int> size_px(const json::Json& object, std::string_view key);

/// The size that an image of a set says it has. Errors: kIo, kCorrupt.
[[nodiscard]] Result<ImageHeader> read_image_size(const std::filesystem::path& image);

/// A name for each camera that is its own and has no folders in it.
void name_cameras(std::vector<PosedCamera>& cameras);

[[nodiscard]] Result<CameraSet> parse_nerf_transforms(const json::Json& file);

}  // namespace edgesplat::io
