// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/store/map_file.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace edgesplat::store {

/// `robot-NNNNN-UUID.map`: every map has a file of its own for life.
[[nodiscard]] std::filesystem::path map_path(const std::filesystem::path& folder, map::RobotId robot,
                                             const map::MapUuid& map);

/// A map file that gave nothing back, and why.
struct RefusedMap {
  std::filesystem::path path;
  Error error;
};
struct MapFolder {
  std::vector<LoadedMap> maps;  ///< of each robot the newest that can be read, by robot
  std::vector<RefusedMap> refused;
};
/// The robots' newest maps, of at most `max_robots`. A folder that is not there is empty. Nothing is removed
/// or changed. kIo where the folder cannot be listed.
[[nodiscard]] Result<MapFolder> load_newest_maps(const std::filesystem::path& folder, std::size_t max_robots);

}  // namespace edgesplat::store
