// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/bag_source.hpp"

#include "common/io/bag_join.hpp"
#include "common/io/bag_mcap.hpp"
#include "common/io/rosbag1.hpp"
#include "common/io/rosbag2_sqlite.hpp"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

namespace edgesplat::io {
namespace {

namespace fs = std::filesystem;

bool has_bag_name(const fs::path& path) {
  const std::string name = path.filename().string();
  constexpr std::array kEndings{".bag", ".mcap", ".db3", ".db3.zstd"};
  return std::ranges::any_of(kEndings, [&](const char* ending) { return name.ends_with(ending); });
}

std::vector<fs::path> bags_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (has_bag_name(at->path())) files.push_back(at->path());
  std::sort(files.begin(), files.end());
  return files;
}

Result<std::unique_ptr<BagSource>> open_file(const fs::path& path) {
  const std::string name = path.filename().string();
  if (name.ends_with(".bag")) return open_rosbag1(path);
  if (name.ends_with(".mcap")) return open_mcap_bag(path);
  return open_rosbag2_sqlite(path);
}

}  // namespace

bool is_bag(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error) ? !bags_in(path).empty() : has_bag_name(path);
}

Result<std::unique_ptr<BagSource>> open_bag(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return fail(Errc::kNotFound, path.string() + " does not exist");
  if (!is_bag(path)) {
    return fail(Errc::kInvalidArgument, path.string() +
                                            " is no recording of ROS: expected a .bag (ROS 1), .mcap or .db3 "
                                            "(ROS 2) file or a folder with such files");
  }
  if (!fs::is_directory(path, error)) return open_file(path);
  std::vector<std::unique_ptr<BagSource>> parts;
  for (const fs::path& file : bags_in(path)) {
    EDGESPLAT_TRY(auto part, open_file(file));
    parts.push_back(std::move(part));
  }
  return join_bags(std::move(parts));
}

std::string ros_type_name(std::string_view type) {
  constexpr std::string_view kMiddle = "/msg/";
  const std::size_t at = type.find(kMiddle);
  if (at == std::string_view::npos) return std::string(type);
  return std::string(type.substr(0, at)) + "/" + std::string(type.substr(at + kMiddle.size()));
}

}  // namespace edgesplat::io
