// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/store/map_folder.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

namespace edgesplat::store {
namespace {

constexpr std::string_view kPrefix = "robot-";
constexpr std::string_view kSuffix = ".map";
constexpr std::size_t kRobotDigits = 5;
constexpr std::size_t kUuidDigits = 32;

/// The robot in a map file's name.
std::optional<map::RobotId> robot_of(std::string_view name) {
  if (name.size() != kPrefix.size() + kRobotDigits + 1 + kUuidDigits + kSuffix.size()) return std::nullopt;
  if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix)) return std::nullopt;
  const std::string_view digits = name.substr(kPrefix.size(), kRobotDigits);
  map::RobotId robot;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), robot.value);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return robot;
}

struct MapFile {
  std::filesystem::file_time_type written;
  std::filesystem::path path;
};

Result<std::map<map::RobotId, std::vector<MapFile>>> list(const std::filesystem::path& folder) {
  std::map<map::RobotId, std::vector<MapFile>> files;
  std::error_code error;
  for (std::filesystem::directory_iterator file(folder, error), end; !error && file != end;
       file.increment(error)) {
    const auto robot = robot_of(file->path().filename().string());
    if (!robot) continue;
    std::error_code gone;
    const auto written = file->last_write_time(gone);
    if (!gone) files[*robot].push_back({written, file->path()});
  }
  if (error && error != std::errc::no_such_file_or_directory)
    return fail(Errc::kIo, "cannot list " + folder.string() + ": " + error.message());
  return files;
}

}  // namespace

std::filesystem::path map_path(const std::filesystem::path& folder, map::RobotId robot,
                               const map::MapUuid& map) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string digits = std::to_string(robot.value);
  digits.insert(0, kRobotDigits - digits.size(), '0');
  std::string name = std::string(kPrefix) + digits + "-";
  for (const std::byte b : map.bytes) {
    name += kHex[std::to_integer<std::size_t>(b >> 4U)];
    name += kHex[std::to_integer<std::size_t>(b & std::byte{0x0F})];
  }
  return folder / (name + std::string(kSuffix));
}

Result<MapFolder> load_newest_maps(const std::filesystem::path& folder, std::size_t max_robots) {
  EDGESPLAT_TRY(auto files, list(folder));
  MapFolder found;
  for (auto& [robot, of_robot] : files) {
    if (found.maps.size() >= max_robots) break;
    std::sort(of_robot.begin(), of_robot.end(), [](const MapFile& a, const MapFile& b) {
      return std::pair(b.written, b.path) < std::pair(a.written, a.path);
    });
    for (const MapFile& file : of_robot) {
      auto loaded = load_map(file.path);
      if (loaded && loaded->map.robot != robot)
        loaded = fail(Errc::kCorrupt, file.path.string() + ": it is the map of another robot");
      if (loaded) {
        found.maps.push_back(*std::move(loaded));
        break;
      }
      found.refused.push_back({file.path, loaded.error()});
    }
  }
  return found;
}

}  // namespace edgesplat::store
