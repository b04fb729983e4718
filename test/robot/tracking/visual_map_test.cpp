// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/visual_map.hpp"

#include "robot/tracking/plane_ray.hpp"
#include "robot/tracking/visual_geometry.hpp"
#include "test/robot/tracking/painted_room.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;

VisualPoint point_at(double x_m) {
  VisualPoint point;
  point.p_in_odom_m = {x_m, 0.0, 0.0};
  return point;
}

TEST(VisualMap, ForgetsTheFarthestAboveItsSize) {
  VisualMap map(100 * (sizeof(VisualPoint) + sizeof(VisualObservation)));
  for (int i = 0; i < 150; ++i) map.observe(map.add(point_at(i)), {});
  map.slide(Vector3d::Zero(), 1000.0);
  EXPECT_LE(map.size(), 90U);
  EXPECT_GT(map.size(), 80U);
  for (std::uint32_t i = 0; i < map.slots(); ++i)
    EXPECT_TRUE(!map.point(i).live || map.point(i).p_in_odom_m.x() < 90.0);
  map.slide(Vector3d(200.0, 0.0, 0.0), 120.0);
  for (std::uint32_t i = 0; i < map.slots(); ++i)
    EXPECT_TRUE(!map.point(i).live || map.point(i).p_in_odom_m.x() >= 80.0);
}

TEST(VisualMap, KeepsTheOldestLookAndTheNewest) {
  VisualMap map(1U << 20U);
  const std::uint32_t index = map.add(point_at(1.0));
  for (int i = 0; i < 9; ++i) {
    VisualObservation look;
    look.log_gain = static_cast<float>(i);
    map.observe(index, look);
  }
  const VisualPoint& point = map.point(index);
  ASSERT_EQ(point.observation_count, VisualPoint::kMaxObservations);
  EXPECT_EQ(map.observation(point.observations[0]).log_gain, 0.0F);
  EXPECT_EQ(map.observation(point.observations[1]).log_gain, 6.0F);
  EXPECT_EQ(map.observation(point.observations[3]).log_gain, 8.0F);
  map.erase(index);
  EXPECT_EQ(map.bytes(), 0U);
}

TEST(LookAt, DerivativeAgreesWithTheLens) {
  const sensor::CameraMount mount = test::PaintedRoom::camera();
  const CameraView view(
      mount.model,
      {Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Vector3d(1, 2, 3).normalized())), Vector3d(0.1, 0.2, -0.3)});
  const Vector3d p(0.5, -0.2, 2.4);
  const auto seen = look_at(view, p);
  ASSERT_TRUE(seen.has_value());
  for (int axis = 0; axis < 3; ++axis) {
    const auto more = look_at(view, p + 1e-6 * Vector3d::Unit(axis));
    EXPECT_LT(((more->pixel - seen->pixel) / 1e-6 - seen->pixel_by_odom.col(axis)).norm(), 1e-2);
  }
  EXPECT_FALSE(look_at(view, Vector3d(0, 0, -2)).has_value());
}

TEST(ChooseReference, TakesTheOldestThatSeesThePointAlike) {
  VisualMap map(1U << 20U);
  VisualPoint point;
  point.p_in_odom_m = {0.0, 0.0, 4.0};
  point.normal = {0.0F, 0.0F, -1.0F};
  const std::uint32_t index = map.add(point);
  const auto look_from = [&](double distance_m) {
    VisualObservation look;
    look.from_camera_m = {0.0F, 0.0F, static_cast<float>(distance_m)};
    look.right_m = {static_cast<float>(distance_m / 160.0), 0.0F, 0.0F};
    look.down_m = {0.0F, static_cast<float>(distance_m / 160.0), 0.0F};
    map.observe(index, look);
  };
  for (const double distance_m : {20.0, 4.4, 4.0}) look_from(distance_m);
  sensor::CameraMount mount = test::PaintedRoom::camera();
  mount.model.distortion = {};
  const CameraView view(mount.model, {});
  const auto seen = look_at(view, point.p_in_odom_m);
  const auto reference = choose_reference(map, map.point(index), *seen, view.camera_in_odom_m);
  ASSERT_TRUE(reference.has_value());
  EXPECT_EQ(reference->observation, map.point(index).observations[1]);  // the first is five times smaller
  EXPECT_NEAR(reference->warp(0, 0), 1.1, 1e-3);
  EXPECT_NEAR(reference->warp(0, 1), 0.0, 1e-6);
  EXPECT_FALSE(is_new_view(map, map.point(index), *seen, view.camera_in_odom_m));
}

TEST(ChooseReference, TellsHowTheDepthGrowsAcrossThePatch) {
  VisualMap map(1U << 20U);
  VisualPoint point;
  point.p_in_odom_m = {0.5, 0.0, 3.0};
  point.normal = {-0.8F, 0.0F, -0.6F};
  const std::uint32_t index = map.add(point);
  VisualObservation look;  // at the focal length of 160 pixels, from the origin
  look.from_camera_m = point.p_in_odom_m.cast<float>();
  // Down is along the plane; right is where the next pixel's ray meets it.
  const Vector3d ray(0.5 / 3.0 + 1.0 / 160.0, 0.0, 1.0);
  const Vector3d normal = point.normal.cast<double>();
  look.right_m = (normal.dot(point.p_in_odom_m) / normal.dot(ray) * ray - point.p_in_odom_m).cast<float>();
  look.down_m = {0.0F, 3.0F / 160.0F, 0.0F};
  look.growth = {look.right_m.z() / 3.0F, 0.0F};
  map.observe(index, look);
  sensor::CameraMount mount = test::PaintedRoom::camera();
  mount.model.distortion = {};
  const CameraView same(mount.model, {});
  const CameraView nearer(mount.model, {Eigen::Quaterniond::Identity(), Vector3d(0.0, 0.0, 1.0)});
  const auto from = [&](const CameraView& view) {
    return *choose_reference(map, map.point(index), *look_at(view, point.p_in_odom_m), view.camera_in_odom_m);
  };
  EXPECT_LT(from(same).growth.norm(), 1e-7);
  // The same step in depth is a larger share of 2 m than of 3 m.
  EXPECT_NEAR(from(nearer).growth.x(), static_cast<double>(look.right_m.z()) * (1.0 / 2.0 - 1.0 / 3.0), 1e-7);
  EXPECT_NEAR(from(nearer).growth.y(), 0.0, 1e-9);
}

/// A landing whose floor was never seen, above the wall of the storey below.
TEST(PlaneRay, DoesNotLookThroughAFloorThatWasNeverSeen) {
  PlaneMap planes{PlaneMapConfig{}};
  test::Random random(4);
  const Symmetric3f noise = pack((1e-6F * Eigen::Matrix3f::Identity()).eval());
  for (int i = 0; i < 4000; ++i) {  // a wall at x = 3, seen from the storey below, from underneath
    const Vector3d p(3.0, random.uniform(-1.0, 1.0), random.uniform(-3.0, -0.5));
    planes.insert({p, noise, Symmetric3f::Zero()}, {1.5, 0.0, -4.0});
  }
  const Vector3d at(3.0, 0.1, -0.9);
  const OdomRay from_above{{1.5, 0.0, 1.5}, (at - Vector3d(1.5, 0.0, 1.5)).normalized()};
  const OdomRay from_below{{1.5, 0.0, -2.5}, (at - Vector3d(1.5, 0.0, -2.5)).normalized()};
  const OdomRay from_behind{{4.5, 0.0, -2.5}, (at - Vector3d(4.5, 0.0, -2.5)).normalized()};
  EXPECT_TRUE(first_plane(planes, from_below).has_value());
  EXPECT_FALSE(first_plane(planes, from_above).has_value());
  EXPECT_TRUE(meet_plane(planes, from_above, at).has_value())
      << "where the scan measures it there is no doubt";
  EXPECT_FALSE(meet_plane(planes, from_behind, at).has_value());
}

TEST(PlaneRay, MeetsTheWallsWhereTheyAre) {
  PlaneMap planes{PlaneMapConfig{}};
  test::PaintedRoom::map(planes);
  test::Random random(8);
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    const OdomRay ray{random.vector(1.0), random.direction()};
    const auto found = first_plane(planes, ray);
    if (!found) continue;
    ++hits;
    const Vector3d truth = test::PaintedRoom::hit(ray.origin_m, ray.direction);
    EXPECT_LT((found->p_in_odom_m - truth).norm(), 0.03) << i;
    EXPECT_LT(found->normal.dot(ray.direction.cast<float>()), 0.0F);
    EXPECT_LT(found->along_sigma_m, 0.1F);
  }
  EXPECT_GT(hits, 140);  // edges and slants are left out
}

}  // namespace
}  // namespace edgesplat::tracking
