// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/app/restored_maps.hpp"

#include <gtest/gtest.h>

namespace edgesplat::app {
namespace {

store::StoredMap map_of(std::uint16_t robot, std::uint64_t session) {
  store::StoredMap map;
  map.robot.value = robot;
  map.session = session;
  return map;
}

TEST(RestoredMaps, GivesAMapToItsSessionOnly) {
  RestoredMaps maps({map_of(1, 10), map_of(2, 20)});
  EXPECT_FALSE(maps.take().has_value());
  maps.heard(map::RobotId{1}, 10);
  maps.heard(map::RobotId{2}, 99);  // another program: its map is given up for good
  maps.heard(map::RobotId{2}, 20);
  maps.heard(map::RobotId{3}, 10);
  const auto map = maps.take();
  ASSERT_TRUE(map.has_value());
  EXPECT_EQ(map->robot.value, 1);
  EXPECT_FALSE(maps.take().has_value());
  maps.heard(map::RobotId{1}, 10);  // once only
  EXPECT_FALSE(maps.take().has_value());
}

}  // namespace
}  // namespace edgesplat::app
