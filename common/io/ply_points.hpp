// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace edgesplat::io {

/// Points with sRGB colours; `rgb` is empty where there are none, else of the same length.
struct PointCloud {
  std::vector<Eigen::Vector3f> points_m;
  std::vector<std::array<std::uint8_t, 3>> rgb;
};

/// Binary little-endian: float x y z, uchar red green blue. kInvalidArgument where the lengths differ.
[[nodiscard]] Status write_points_ply(const std::filesystem::path& path, const PointCloud& cloud);
/// Any number type for x y z, red green blue optional, extra properties ignored; binary or ASCII.
[[nodiscard]] Result<PointCloud> read_points_ply(const std::filesystem::path& path);
[[nodiscard]] Result<PointCloud> parse_points_ply(std::span<const std::byte> bytes);

}  // namespace edgesplat::io
