// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/config/config_reader.hpp"
#include "common/sensor/rig.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace edgesplat::sensor {

/// The fields of rig.toml: [lidar] with [lidar.body_from_lidar], or [[lidar]] for each of several, [imu] and
/// [camera] where the robot has them.
void describe(config::ConfigReader& reader, Rig& rig);

/// Parses the text of a rig.toml; `name` is for messages. Errors: kInvalidConfig with every problem.
[[nodiscard]] Result<Rig> parse_rig(std::string_view text, std::string name);
/// The same, from a file; kNotFound or kIo where it cannot be read.
[[nodiscard]] Result<Rig> load_rig(const std::filesystem::path& path);
/// The text of the rig.toml that parse_rig() reads back.
[[nodiscard]] std::string print_rig(const Rig& rig);

}  // namespace edgesplat::sensor
