// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/depth_cells.hpp"

#include "test/robot/tracking/painted_room.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace edgesplat::tracking {
namespace {

/// A wall across the view at 4 m, measured every 5 cm.
std::vector<Eigen::Vector3f> wall() {
  std::vector<Eigen::Vector3f> points;
  for (int i = -40; i <= 40; ++i)
    for (int k = -40; k <= 40; ++k)
      points.emplace_back(0.05F * static_cast<float>(i), 0.05F * static_cast<float>(k), 4.0F);
  return points;
}

PlaneInView on_the_wall(float x_m) {
  const auto camera = test::PaintedRoom::camera().model;
  const Eigen::Vector3f p(x_m, 0.0F, 4.0F);
  return {camera.project(p.cast<double>())->cast<float>(), p, Eigen::Vector3f(0, 0, -1)};
}

TEST(DepthCells, AgreeWithTheWallAndNotWithWhatStandsBefore) {
  std::vector<Eigen::Vector3f> points = wall();
  std::erase_if(points,
                [](const Eigen::Vector3f& p) { return std::abs(p.x() - 1.0F) < 0.1F; });  // its shadow
  for (int i = 0; i < 60; ++i) points.emplace_back(0.5F, 0.01F * static_cast<float>(i - 30), 2.0F);  // a post
  DepthCells cells;
  cells.build(points, {}, test::PaintedRoom::camera().model);
  EXPECT_TRUE(cells.agree(on_the_wall(0.0F)));
  EXPECT_FALSE(cells.agree(on_the_wall(1.0F)));  // behind the post, which is at half the distance
  PlaneInView gone = on_the_wall(0.0F);
  gone.p_in_camera_m.z() = 3.0F;
  EXPECT_FALSE(cells.agree(gone));
}

TEST(DepthCells, ASingleReturnIsNoWitness) {
  std::vector<Eigen::Vector3f> points = wall();
  points.emplace_back(0.0F, 0.0F, 2.0F);
  DepthCells cells;
  cells.build(points, {}, test::PaintedRoom::camera().model);
  EXPECT_TRUE(cells.agree(on_the_wall(0.0F)));
}

TEST(DepthCells, WhatStandsOutOfTheWallIsNoticedWhereTheNoiseIsKnown) {
  sensor::LidarModel lidar;
  lidar.range_sigma_m = 0.02;
  lidar.bearing_sigma_rad = 1e-4;
  std::vector<Eigen::Vector3f> points = wall();
  test::Random random(3);
  for (Eigen::Vector3f& p : points) p.z() += 0.02F * static_cast<float>(random.normal());
  DepthCells with_noise{PointNoise(lidar)}, without;
  for (DepthCells* cells : {&with_noise, &without})
    cells->build(points, {}, test::PaintedRoom::camera().model);
  PlaneInView frame = on_the_wall(0.0F);
  frame.p_in_camera_m.z() -= 0.03F;
  EXPECT_TRUE(without.agree(frame)) << "less than a single point tells";
  EXPECT_FALSE(with_noise.agree(frame)) << "but not than the mean of 40 does";
  int agreed = 0;
  for (int i = -15; i <= 15; ++i)
    agreed += with_noise.agree(on_the_wall(0.1F * static_cast<float>(i))) ? 1 : 0;
  EXPECT_GT(agreed, 20) << "of 31 places that are on the wall";
}

TEST(DepthCells, FindTheNearestReturn) {
  DepthCells cells;
  cells.build(wall(), {}, test::PaintedRoom::camera().model);
  const auto near = cells.nearest(on_the_wall(0.52F).pixel);
  ASSERT_TRUE(near.has_value());
  EXPECT_NEAR(near->x(), 0.5F, 1e-4F);
  EXPECT_FALSE(cells.nearest({2.0F, 2.0F}).has_value());  // the wall does not reach there
  cells.build({}, {}, test::PaintedRoom::camera().model);
  EXPECT_TRUE(cells.agree(on_the_wall(0.0F)));
}

}  // namespace
}  // namespace edgesplat::tracking
