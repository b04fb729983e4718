// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/measurement.hpp"

#include <filesystem>
#include <string_view>
#include <vector>

namespace edgesplat::desk {

/// IMU samples in EuRoC's layout: rows "t_ns, gyro x, y, z (rad/s), accelerometer x, y, z (m/s^2)"; empty
/// rows and rows that start with '#' or have no value after the stamp are skipped. Stamps may be written as
/// decimals (1.40363657975856E+018). Arrival = stamp. Errors: kCorrupt with file:line for a row that is not
/// seven finite numbers, or whose stamp does not rise.
[[nodiscard]] Result<std::vector<sensor::ImuSample>> parse_imu_csv(std::string_view text,
                                                                   std::string_view name);
/// The same, from a file; kNotFound or kIo where it cannot be read.
[[nodiscard]] Result<std::vector<sensor::ImuSample>> read_imu_csv(const std::filesystem::path& path);

}  // namespace edgesplat::desk
