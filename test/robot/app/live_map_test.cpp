// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/live_map.hpp"

#include "test/robot/local_mapping/facing_wall.hpp"
#include "test/support/temp_dir.hpp"
#include "test/support/test_domain.hpp"

#include <gtest/gtest.h>

namespace edgesplat::app {
namespace {

struct Maker {
  explicit Maker(robot_config::RobotConfig config) {
    config.server.link.domain = test::test_domain();
    auto made = LiveMap::create(config, false, clock, folder.path(), metrics);
    EXPECT_TRUE(made.has_value()) << made.error().context;
    map = *std::move(made);
  }
  test::TempDir folder;
  SteadyClock clock;
  metrics::Registry metrics;
  std::unique_ptr<LiveMap> map;
};

TEST(LiveMap, WithoutAServerTheRobotMapsByItself) {
  robot_config::RobotConfig config;
  config.server.enabled = false;
  Maker maker(config);
  EXPECT_EQ(maker.map->snapshot()->size(), 0U);
  maker.map->submit(test::facing_wall(1));
  EXPECT_GT(maker.map->newest_snapshot()->size(), 500U);
  EXPECT_TRUE(maker.map->drain(nanoseconds(0)));
  maker.map->publish_counters(maker.metrics);
  EXPECT_EQ(maker.metrics.counter("local.keyframes").value(), 1U);
}

TEST(LiveMap, SwitchedOffItMapsNothing) {
  robot_config::RobotConfig config;
  config.server.enabled = false;
  config.local.enabled = false;
  Maker maker(config);
  maker.map->submit(test::facing_wall(1));
  EXPECT_EQ(maker.map->newest_snapshot()->size(), 0U);
}

TEST(LiveMap, WithAServerThatIsNotThereTheRobotMapsFromTheFirstKeyframeOn) {
  Maker maker({});
  maker.map->submit(test::facing_wall(1));
  EXPECT_GT(maker.map->newest_snapshot()->size(), 500U);
}

}  // namespace
}  // namespace edgesplat::app
