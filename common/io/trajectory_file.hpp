// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/time/time.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::io {

struct StampedPose {
  HostTime stamp{};
  geometry::RigidTransform world_from_body;
};

/// "1403636579.763555527" or "1.5e-1" to whole nanoseconds, exactly (digits beyond the ninth are rounded);
/// nothing where it is no number or leaves the range of HostTime.
[[nodiscard]] std::optional<HostTime> parse_decimal_seconds(std::string_view text);
/// "1403636579.763555527": nine decimals, so that parsing gives the same nanosecond.
[[nodiscard]] std::string format_decimal_seconds(HostTime stamp);

/// TUM: lines "t x y z qx qy qz qw", '#' comments. Errors are kCorrupt with file:line. Quaternions must have
/// unit length within 1 %, and are normalised. The order of the file is kept.
[[nodiscard]] Result<std::vector<StampedPose>> read_tum(const std::filesystem::path& path);
[[nodiscard]] Result<std::vector<StampedPose>> parse_tum(std::string_view text, std::string_view file_name);
[[nodiscard]] Status write_tum(const std::filesystem::path& path, std::span<const StampedPose> poses);

/// KITTI odometry: 12 numbers a line, [R t] row by row; no stamps. R must be a rotation within 1e-2.
[[nodiscard]] Result<std::vector<geometry::RigidTransform>> read_kitti(const std::filesystem::path& path);
[[nodiscard]] Result<std::vector<geometry::RigidTransform>> parse_kitti(std::string_view text,
                                                                        std::string_view file_name);
[[nodiscard]] Status write_kitti(const std::filesystem::path& path,
                                 std::span<const geometry::RigidTransform> poses);
/// KITTI times.txt: one decimal number of seconds a line.
[[nodiscard]] Result<std::vector<HostTime>> read_times(const std::filesystem::path& path);

}  // namespace edgesplat::io
