// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/hole_fill.hpp"

#include <gtest/gtest.h>

namespace edgesplat::mapping {
namespace {

/// A level camera 1 m over the floor of a map with z up, looking along x; the body is the camera's place.
struct Scene {
  geometry::RigidTransform map_from_body;
  StoredView view;
  GroundPlane ground;
  std::vector<float> alpha;

  Scene() {
    const geometry::CameraModel camera{geometry::CameraKind::kPinhole, 64, 48, 40.0, 40.0, 31.5, 23.5, {}};
    map_from_body.translation_m = {2.0, 3.0, 1.0};
    Eigen::Matrix3d body_from_camera;
    body_from_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    geometry::RigidTransform turn;
    turn.rotation = Eigen::Quaterniond(body_from_camera);
    view.map_from_camera = map_from_body * turn;
    view.undistorter = std::make_shared<image::Undistorter>(camera);
    view.picture = sensor::ImageRgb8(64, 48, 90);
    alpha.assign(64 * 48, 0.0F);
  }
  [[nodiscard]] std::vector<Eigen::Vector3d> filled(const HoleFillOptions& options = {}) const {
    std::vector<Eigen::Vector3d> points_m;
    for (const auto& p : fill_holes(view, map_from_body, ground, alpha, options)) {
      EXPECT_EQ(p.rgb[1], 90);
      EXPECT_TRUE(p.has_colour);
      points_m.push_back(map_from_body * p.p_in_body_m.cast<double>());
    }
    return points_m;
  }
};

TEST(HoleFill, PutsEmptyPixelsOntoTheFloor) {
  const Scene scene;
  const auto points_m = scene.filled();
  ASSERT_GT(points_m.size(), 50U);
  for (const auto& p : points_m) {
    EXPECT_NEAR(p.z(), 0.0, 1e-4);
    EXPECT_LE(p.x() - 2.0, HoleFillOptions().max_depth_m + 1e-3);
  }
}

TEST(HoleFill, LeavesWhatTheMapCoversAndTheSky) {
  Scene scene;
  scene.alpha.assign(64 * 48, 0.95F);
  EXPECT_TRUE(scene.filled().empty());
  scene.alpha.assign(64 * 48, 0.95F);
  for (std::size_t pixel = 0; pixel < 64 * 20; ++pixel) scene.alpha[pixel] = 0.0F;  // above the horizon
  EXPECT_TRUE(scene.filled().empty());
}

TEST(HoleFill, AWallGoesOnDownwardsToTheFloor) {
  Scene scene;
  // A wall 1.5 m ahead over the whole width, measured only above the horizon.
  for (std::uint32_t x = 0; x < 64; ++x) scene.view.depths.push_back({64 * 10 + x, 1.5F});
  const auto points_m = scene.filled();
  int on_wall = 0, on_floor = 0;
  for (const auto& p : points_m) {
    if (p.z() > 1e-3) {
      EXPECT_NEAR(p.x() - 2.0, 1.5, 1e-4);
      ++on_wall;
    } else {
      EXPECT_LE(p.x() - 2.0, 1.5 + 1e-3) << "no floor behind the wall";
      ++on_floor;
    }
  }
  EXPECT_GT(on_wall, 10);
  EXPECT_EQ(on_floor, 0) << "the floor in front of this wall is out of the picture";
}

TEST(HoleFill, NeedsACameraOverTheFloor) {
  Scene scene;
  scene.ground.offset_m = 5.0;
  EXPECT_TRUE(scene.filled().empty());
}

}  // namespace
}  // namespace edgesplat::mapping
