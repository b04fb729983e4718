// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/camera_render.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::simulate {
namespace {

CameraView view_along(const World& world, std::size_t waypoint, double time_s) {
  CameraView view;
  view.camera = {geometry::CameraKind::kPinhole, 96, 80, 60.0, 60.0, 47.5, 39.5, {-0.1, 0.01, 0.001, 0.0}};
  const World::Path path = world.path();
  const Eigen::Vector3d ahead = (path.waypoints_m[waypoint + 1] - path.waypoints_m[waypoint]).normalized();
  Eigen::Matrix3d world_from_camera;
  world_from_camera.col(2) = ahead;
  world_from_camera.col(1) = -Eigen::Vector3d::UnitZ();
  world_from_camera.col(0) = world_from_camera.col(1).cross(ahead);
  view.world_from_camera.rotation = Eigen::Quaterniond(world_from_camera);
  view.world_from_camera.translation_m = path.waypoints_m[waypoint] + Eigen::Vector3d(0, 0, 0.3);
  view.time_s = time_s;
  return view;
}

Ray ray_through(const CameraView& view, int x, int y) {
  return {view.world_from_camera.translation_m,
          view.world_from_camera.rotation * view.camera.unproject({x, y}), view.time_s};
}

std::unique_ptr<World> world(const char* name, int pedestrians) {
  return *World::create({name, pedestrians, 0, 4});
}

TEST(CameraRender, MaskAndDepthAreWhatARayThroughThePixelMeets) {
  for (const char* name : {"corridor", "square"}) {
    const auto w = world(name, 40);
    const CameraView view = view_along(*w, 5, 2.5);
    const CameraPicture picture = render_picture(*w, view);
    int movers = 0;
    for (int y = 0; y < 80; ++y) {
      for (int x = 0; x < 96; ++x) {
        const Ray ray = ray_through(view, x, y);
        const auto hit = w->cast(ray, Visibility::kEverything);
        ASSERT_EQ(*picture.movers.pixel(x, y), hit ? hit->mover : 0);
        const double z = hit ? hit->range_m * view.camera.unproject({x, y}).z() : 0.0;
        ASSERT_NEAR(*picture.depth.pixel(x, y), z, 1e-4 * (1.0 + z));
        movers += *picture.movers.pixel(x, y) != 0 ? 1 : 0;
      }
    }
    EXPECT_GT(movers, 50) << name;
  }
}

TEST(CameraRender, CleanPictureIsThatOfTheSamePlaceWithoutMovers) {
  const auto full = world("corridor", 40), empty = world("corridor", 0);
  const CameraView view = view_along(*full, 20, 1.0);
  const CameraPicture with = render_picture(*full, view), without = render_picture(*empty, view);
  EXPECT_EQ(without.full.values, without.clean.values);
  EXPECT_NE(with.full.values, with.clean.values);
  double sum = 0.0;
  for (std::size_t i = 0; i < with.clean.values.size(); ++i)
    sum += std::abs(static_cast<double>(with.clean.values[i] - without.clean.values[i]));
  EXPECT_LT(sum / static_cast<double>(with.clean.values.size()), 0.002);  // more rays where movers end
}

TEST(CameraRender, IsReproducible) {
  const auto first = world("corridor", 20), second = world("corridor", 20);
  const CameraView view = view_along(*first, 3, 0.7);
  const CameraPicture a = render_picture(*first, view), b = render_picture(*second, view);
  EXPECT_EQ(a.full.values, b.full.values);
  EXPECT_EQ(a.clean.values, b.clean.values);
  EXPECT_EQ(a.full.values, render_picture(*first, view).full.values);  // now from the stored light
}

TEST(CameraRender, DiffersLittleFromAFinerPicture) {
  // Against aliasing: a picture rendered at four times the size and averaged is the same one.
  const auto w = world("corridor", 0);
  CameraView view = view_along(*w, 8, 0.0);
  view.camera.distortion = {};
  const CameraPicture coarse = render_picture(*w, view);
  view.camera = view.camera.scaled(4.0);
  const CameraPicture fine = render_picture(*w, view);
  double sum = 0.0;
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 96; ++x) {
      float mean = 0.0F;
      for (int k = 0; k < 16; ++k) mean += fine.full.pixel(4 * x + k % 4, 4 * y + k / 4)[1] / 16.0F;
      sum += std::abs(static_cast<double>(mean - coarse.full.pixel(x, y)[1]));
    }
  }
  EXPECT_LT(sum / (80 * 96), 0.012);
}

}  // namespace
}  // namespace edgesplat::simulate
