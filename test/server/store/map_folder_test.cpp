// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/store/map_folder.hpp"

#include "test/support/map_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

namespace edgesplat::store {
namespace {

StoredMap sample(std::uint16_t robot, std::uint8_t name, std::size_t gaussians) {
  StoredMap map;
  map.map.bytes[15] = std::byte{name};
  map.robot.value = robot;
  map.gaussians = test::random_gaussians(gaussians, 1);
  return map;
}

/// Saves the map as if written `age` ago.
std::filesystem::path save(const std::filesystem::path& folder, const StoredMap& map,
                           std::chrono::hours age) {
  auto path = map_path(folder, map.robot, map.map);
  EXPECT_TRUE(save_map(path, map).has_value());
  std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now() - age);
  return path;
}

TEST(MapFolder, NamesEveryMapAfterRobotAndUuid) {
  EXPECT_EQ(map_path("/f", map::RobotId{7}, sample(7, 0xAB, 0).map),
            "/f/robot-00007-000000000000000000000000000000ab.map");
}

TEST(MapFolder, GivesTheNewestOfEachRobot) {
  const test::TempDir folder;
  save(folder.path(), sample(1, 1, 10), std::chrono::hours(3));
  save(folder.path(), sample(1, 2, 20), std::chrono::hours(1));
  save(folder.path(), sample(1, 3, 30), std::chrono::hours(2));
  save(folder.path(), sample(2, 4, 40), std::chrono::hours(9));
  std::ofstream(folder.path() / "notes.map") << "not ours";
  const auto found = load_newest_maps(folder.path(), 4);
  ASSERT_TRUE(found.has_value());
  ASSERT_EQ(found->maps.size(), 2U);
  EXPECT_EQ(found->maps[0].map.gaussians.size(), 20U);
  EXPECT_EQ(found->maps[1].map.gaussians.size(), 40U);
  EXPECT_TRUE(found->refused.empty());
  EXPECT_EQ(load_newest_maps(folder.path(), 1)->maps.size(), 1U);
}

TEST(MapFolder, RefusesWithAReasonAndTakesTheOneBefore) {
  const test::TempDir folder;
  save(folder.path(), sample(1, 1, 10), std::chrono::hours(3));
  const auto cut = save(folder.path(), sample(1, 2, 20), std::chrono::hours(2));
  const auto written = std::filesystem::last_write_time(cut);
  std::filesystem::resize_file(cut, 5);
  std::filesystem::last_write_time(cut, written);
  const auto foreign = save(folder.path(), sample(9, 3, 30), std::chrono::hours(1));
  std::filesystem::rename(foreign, map_path(folder.path(), map::RobotId{1}, sample(1, 3, 0).map));
  const auto found = load_newest_maps(folder.path(), 4);
  ASSERT_TRUE(found.has_value());
  ASSERT_EQ(found->maps.size(), 1U);
  EXPECT_EQ(found->maps[0].map.gaussians.size(), 10U);
  ASSERT_EQ(found->refused.size(), 2U);
  EXPECT_NE(found->refused[0].error.context.find("another robot"), std::string::npos);
  EXPECT_EQ(found->refused[1].path, cut);
  EXPECT_TRUE(std::filesystem::exists(cut));
}

TEST(MapFolder, AFolderThatIsNotThereIsEmpty) {
  const auto found = load_newest_maps("/nonexistent/store", 4);
  ASSERT_TRUE(found.has_value());
  EXPECT_TRUE(found->maps.empty());
}

}  // namespace
}  // namespace edgesplat::store
