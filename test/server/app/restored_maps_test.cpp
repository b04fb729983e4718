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
  RestoredMaps maps({map_of(1, 10), map_of(2, 20)}, {});
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

ingest::IngestedKeyframe keyframe_of(std::uint16_t robot, std::uint64_t session, std::uint32_t id) {
  ingest::IngestedKeyframe keyframe;
  keyframe.robot.value = robot;
  keyframe.session = session;
  keyframe.keyframe.id = {id};
  return keyframe;
}

TEST(RestoredMaps, GivesTheKeyframesOfASessionAfterItsMapInTheirOrder) {
  RestoredMaps maps({map_of(1, 10)}, {keyframe_of(1, 10, 5), keyframe_of(2, 20, 7), keyframe_of(1, 10, 4),
                                      keyframe_of(3, 30, 1)});
  EXPECT_FALSE(maps.has_keyframe());
  maps.heard(map::RobotId{1}, 10);
  maps.heard(map::RobotId{3}, 31);  // another program: its keyframes are given up
  EXPECT_TRUE(maps.has_keyframe());
  EXPECT_FALSE(maps.take_keyframe().has_value()) << "the map first";
  EXPECT_TRUE(maps.take().has_value());
  EXPECT_EQ(maps.take_keyframe()->keyframe.id.value, 5U);
  EXPECT_EQ(maps.take_keyframe()->keyframe.id.value, 4U);
  EXPECT_FALSE(maps.take_keyframe().has_value());
  maps.heard(map::RobotId{3}, 30);
  EXPECT_FALSE(maps.has_keyframe());
  maps.heard(map::RobotId{2}, 20);  // without a map of its own
  EXPECT_EQ(maps.take_keyframe()->keyframe.id.value, 7U);
}

}  // namespace
}  // namespace edgesplat::app
