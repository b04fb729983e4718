// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/moving.hpp"

#include "common/time/clock.hpp"
#include "kernels/mapping/engine.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::mapping {
namespace {

const geometry::CameraModel kCamera{geometry::CameraKind::kPinhole, 96, 72, 60.0, 60.0, 47.5, 35.5, {}};

/// The body stands 1 m over the floor at the map's (0, y, 1) and looks along x; the camera is at its origin.
geometry::RigidTransform body_at(double y_m) {
  geometry::RigidTransform map_from_body;
  map_from_body.translation_m = {0.0, y_m, 1.0};
  return map_from_body;
}
geometry::RigidTransform body_from_camera() {
  Eigen::Matrix3d rotation;
  rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  geometry::RigidTransform transform;
  transform.rotation = Eigen::Quaterniond(rotation);
  return transform;
}

/// A room whose far wall is at x = 6 m, as the LiDAR of a body at y_m measures it (nothing below the horizon
/// but the floor that stands for itself), with a person 2.5 m ahead at person_y_m where one is given.
map::Keyframe keyframe(std::uint32_t id, double y_m, std::optional<double> person_y_m) {
  map::Keyframe made;
  made.id = map::KeyframeId{id};
  made.odom_from_body = body_at(y_m);
  made.camera = sensor::CameraMount{kCamera, body_from_camera(), 0.0};
  made.exposure_s = 0.01F;
  for (double py = -3.0; py <= 3.0; py += 0.1) {
    for (double pz = 0.6; pz <= 3.0; pz += 0.1) {
      // On the ray to the wall, in the body frame; the LiDAR does not look far down.
      Eigen::Vector3d p(6.0, py - y_m, pz - 1.0);
      map::ColouredPoint point{p.cast<float>(), {200, 200, 200}, true};
      if (person_y_m) {
        const Eigen::Vector3d at = p * (2.5 / 6.0);
        if (std::abs(at.y() + y_m - *person_y_m) < 0.2 && at.z() + 1.0 < 1.8)
          point = {at.cast<float>(), {20, 20, 90}, true};
      }
      made.points_in_body.push_back(point);
    }
  }
  for (double px = 1.0; px <= 5.5; px += 0.1) {
    for (double py = -1.0; py <= 1.0; py += 0.2)
      made.points_in_body.push_back({Eigen::Vector3d(px, py - y_m, -1.0).cast<float>(), {90, 90, 90}, true});
  }
  return made;
}

StoredView view_of(const map::Keyframe& keyframe) {
  const sensor::ImageRgb8 picture(96, 72, 120);
  auto view =
      make_view(keyframe, keyframe.odom_from_body, picture, std::make_shared<image::Undistorter>(kCamera));
  EXPECT_TRUE(view.has_value());
  return *std::move(view);
}

TEST(MovingDepths, AreThoseOfWhatWasNotThereBefore) {
  const StoredView before = view_of(keyframe(1, 0.0, std::nullopt));
  const StoredView now = view_of(keyframe(2, 0.1, 0.3));
  const auto moving = moving_depths(now, DepthPicture(before), {});
  ASSERT_GT(moving.size(), 20U);
  for (const SparseDepth& d : moving) EXPECT_NEAR(d.depth_m, 2.5F, 0.01F);
  // The wall behind the person is no less there for being hidden.
  EXPECT_TRUE(moving_depths(before, DepthPicture(now), {}).empty());
}

TEST(MovingDepths, WhatStandsStillIsNotMoving) {
  const StoredView a = view_of(keyframe(1, 0.0, 0.3));
  const StoredView b = view_of(keyframe(2, 0.05, 0.3));
  EXPECT_TRUE(moving_depths(a, DepthPicture(b), {}).empty());
  EXPECT_TRUE(moving_depths(b, DepthPicture(a), {}).empty());
}

TEST(MovingMask, ReachesDownToTheFloorAndNotBelow) {
  const StoredView view = view_of(keyframe(1, 0.0, std::nullopt));
  const GroundPlane floor;  // z = 0
  MovingMask mask(view);
  EXPECT_TRUE(mask.empty());
  const SparseDepth chest{35 * 96 + 47, 2.5F};  // 1 m over the floor, straight ahead
  mask.mark(chest, &floor, {});
  StoredView hidden = view;
  mask.hide_in(hidden);
  ASSERT_EQ(hidden.ignored.size(), 96U * 72U);
  const int foot = 35 + static_cast<int>(60.0 * 1.0 / 2.5);  // row of the floor at 2.5 m
  for (int y = 35; y <= foot; ++y) EXPECT_TRUE(hidden.ignored[static_cast<std::size_t>(y) * 96 + 47]) << y;
  EXPECT_FALSE(hidden.ignored[static_cast<std::size_t>(foot + 6) * 96 + 47]);
  EXPECT_FALSE(hidden.ignored[std::size_t{50} * 96 + 60]);
  EXPECT_TRUE(mask.holds({2.4F, 0.0F, 0.5F}, 0.5F));
  EXPECT_FALSE(mask.holds({6.0F, 0.0F, 1.0F}, 0.5F)) << "the wall behind";
  EXPECT_TRUE(mask.hides({6.0F, 0.0F, 1.0F}, 0.5F));
  EXPECT_FALSE(mask.hides({1.0F, 0.0F, 1.0F}, 0.5F)) << "something in front";
}

TEST(MovingMask, MarksTheFootprintAndNothingElse) {
  StoredView view = view_of(keyframe(1, 0.0, std::nullopt));
  MovingMask mask(view);
  mask.mark(Eigen::Vector3f(2.0F, 0.0F, 1.0F), 0.2F);  // 6 px
  mask.hide_in(view);
  EXPECT_TRUE(view.ignored[std::size_t{36} * 96 + 48]);
  EXPECT_TRUE(view.ignored[std::size_t{36} * 96 + 52]);
  EXPECT_FALSE(view.ignored[std::size_t{36} * 96 + 57]);
  MovingMask behind(view);
  behind.mark(Eigen::Vector3f(-2.0F, 0.0F, 1.0F), 0.2F);
  EXPECT_TRUE(behind.empty());
}

/// Gaussians nearer than the wall and over the floor: the person's.
std::size_t of_person(const gaussian::GaussianCloud& cloud) {
  std::size_t count = 0;
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    const float* mean = &cloud.means_m[3 * row];
    count += mean[0] > 2.2F && mean[0] < 2.8F && mean[2] > 0.2F ? 1U : 0U;
  }
  return count;
}

std::unique_ptr<MappingEngine> engine_after(const std::vector<map::Keyframe>& keyframes, IdAllocator& ids,
                                            const Clock& clock, bool hide_moving) {
  EngineOptions options;
  options.moving.enabled = hide_moving;
  options.seen_through.enabled = false;
  auto engine = MappingEngine::create(options, ids, clock);
  EXPECT_TRUE(engine.has_value());
  const sensor::ImageRgb8 picture(96, 72, 120);
  for (const map::Keyframe& k : keyframes) EXPECT_TRUE((*engine)->add(k, k.odom_from_body, &picture));
  return *std::move(engine);
}

TEST(MappingEngine, APersonWhoWalksThroughLeavesNothing) {
  const std::vector<map::Keyframe> walk = {keyframe(1, 0.0, -0.6), keyframe(2, 0.05, 0.0),
                                           keyframe(3, 0.1, 0.6)};
  const VirtualClock clock;
  IdAllocator ids(7);
  EXPECT_GT(of_person(engine_after(walk, ids, clock, false)->cloud()), 50U);
  const auto engine = engine_after(walk, ids, clock, true);
  EXPECT_EQ(of_person(engine->cloud()), 0U);
  EXPECT_GT(engine->cloud().size(), 500U);
  EXPECT_GT(engine->gone(), 0U);
  EXPECT_EQ(engine->take_changes().removed.size(), engine->gone());
}

}  // namespace
}  // namespace edgesplat::mapping
