// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/map_look.hpp"

#include "test/robot/local_mapping/facing_wall.hpp"

#include <gtest/gtest.h>

namespace edgesplat::app {
namespace {

TEST(MapLook, DrawsTheLiveMapOnceThereIsOne) {
  robot_config::RobotConfig config;
  config.server.enabled = false;
  const SteadyClock clock;
  metrics::Registry metrics;
  const auto map = LiveMap::create(config, true, clock, {}, metrics);
  ASSERT_TRUE(map.has_value()) << map.error().context;
  MapLook look(**map, clock, metrics);
  const sensor::CameraMount camera = test::forward_camera();
  EXPECT_FALSE(look.draw(camera.model, camera.body_from_camera).has_value());

  (*map)->submit(test::facing_wall(1));
  // From half a metre closer to the wall, which stands 3 m ahead.
  geometry::RigidTransform body;
  body.translation_m.x() = 0.5;
  const auto picture = look.draw(camera.model, body * camera.body_from_camera);
  ASSERT_TRUE(picture.has_value());
  EXPECT_EQ(picture->picture.width_px, camera.model.width_px);
  EXPECT_NEAR(*picture->depth_m.pixel(32, 24), 2.5F, 0.05F);
  EXPECT_GT(*picture->alpha.pixel(32, 24), 0.8F);
  EXPECT_EQ(metrics.histogram("tracking.map_draw_ms").summary().count, 1U);
}

}  // namespace
}  // namespace edgesplat::app
