// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/scan_update.hpp"

#include "common/geometry/so3.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;

/// Points on the walls of a room of 10 x 8 x 3 m, seen from a body near its middle.
Vector3d wall_point(test::Random& random, bool floor_only) {
  Vector3d p(random.uniform(-5, 5), random.uniform(-4, 4), random.uniform(0, 3));
  const std::uint64_t side = floor_only ? 4 : random.below(6);
  const double bounds[6] = {-5, 5, -4, 4, 0, 3};
  p(static_cast<int>(side / 2)) = bounds[side];
  return p;
}

class ScanUpdate : public testing::Test {
 protected:
  void map_room(bool floor_only = false) {
    test::Random random(1);
    const Symmetric3f noise = pack((1e-4F * Eigen::Matrix3f::Identity()).eval());
    for (int i = 0; i < 60000; ++i) {
      const Vector3d jitter = 0.01 * Vector3d(random.normal(), random.normal(), random.normal());
      map_.insert({wall_point(random, floor_only) + jitter, noise}, Vector3d::Zero());
    }
  }
  /// What the body at `truth_` sees.
  std::vector<Eigen::Vector3f> scan(int points, bool floor_only = false) {
    test::Random random(2);
    std::vector<Eigen::Vector3f> seen;
    for (int i = 0; i < points; ++i) {
      const Vector3d jitter = 0.01 * Vector3d(random.normal(), random.normal(), random.normal());
      seen.push_back((truth_.inverse() * (wall_point(random, floor_only) + jitter)).cast<float>());
    }
    return seen;
  }
  FilterBelief prior(double sigma) {
    FilterBelief belief;
    belief.state.odom_from_body = {truth_.rotation * geometry::so3_exp({0.01, -0.008, 0.02}),
                                   truth_.translation_m + Vector3d(0.06, -0.05, 0.04)};
    belief.covariance = sigma * sigma * ErrorMatrix::Identity();
    return belief;
  }
  ScanUpdateResult update(const FilterBelief& belief, std::span<const Eigen::Vector3f> points) {
    return updater_.run(belief, belief.state, {points, {&beam_, 1}}, map_);
  }
  double position_error(const ScanUpdateResult& result) const {
    return (result.belief.state.odom_from_body.translation_m - truth_.translation_m).norm();
  }

  geometry::RigidTransform truth_{geometry::so3_exp({0.02, 0.03, 0.6}), {0.4, -0.7, 1.1}};
  Beam beam_{Eigen::Vector3f::Zero(), PointNoise(sensor::LidarModel{})};
  PlaneMap map_{PlaneMapConfig{}};
  BlockLoop loop_{1};
  ScanUpdater updater_{ScanUpdateConfig{}, loop_};
};

TEST(PointToPlane, RowAgreesWithNumericDifferences) {
  test::Random random(3);
  const geometry::RigidTransform pose = random.transform();
  const Vector3d p = random.vector(5.0), centre = random.vector(5.0), normal = random.direction();
  const PointToPlane line = point_to_plane(pose, p, normal, centre);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    FilterState state;
    state.odom_from_body = pose;
    const ErrorVector nudge = kStep * ErrorVector::Unit(i);
    const double numeric =
        (point_to_plane(plus(state, nudge).odom_from_body, p, normal, centre).residual_m -
         point_to_plane(plus(state, -nudge).odom_from_body, p, normal, centre).residual_m) /
        (2.0 * kStep);
    EXPECT_NEAR(line.row(i), numeric, 1e-7) << i;
  }
}

TEST_F(ScanUpdate, FindsThePoseInARoom) {
  map_room();
  const auto points = scan(2000);
  const ScanUpdateResult result = update(prior(0.1), points);
  ASSERT_TRUE(result.updated);
  EXPECT_LT(position_error(result), 0.003);
  EXPECT_LT(result.belief.state.odom_from_body.rotation.angularDistance(truth_.rotation), 0.001);
  EXPECT_GT(result.translation_conditioning, 0.1);
  EXPECT_GT(result.last.used, 1500);
  EXPECT_LT(result.belief.covariance(kPos, kPos), 1e-4);
  EXPECT_LT((result.belief.covariance - result.belief.covariance.transpose()).norm(), 1e-12);
}

// However many points lie on one plane, they tell its place no better than the plane itself is known.
TEST_F(ScanUpdate, PointsOnOnePlaneShareItsError) {
  test::Random random(4);
  const Symmetric3f noise = pack((1e-4F * Eigen::Matrix3f::Identity()).eval());
  for (int i = 0; i < 10; ++i) {
    map_.insert(
        {{random.uniform(0.05, 0.95), random.uniform(0.05, 0.95), 0.5 + 0.01 * random.normal()}, noise},
        {0.5, 0.5, 2.0});
  }
  const PlaneMatch floor = map_.find({0.5, 0.5, 0.5});
  ASSERT_NE(floor.plane, nullptr);
  const double least_m2 = floor.plane->offset_variance_m2;
  const Beam above{{0.5F, 0.5F, 2.0F}, PointNoise(sensor::LidarModel{})};
  const auto information_of = [&](int points) {
    std::vector<Eigen::Vector3f> scan;
    for (int i = 0; i < points; ++i) {
      scan.emplace_back(static_cast<float>(random.uniform(0.3, 0.7)),
                        static_cast<float>(random.uniform(0.3, 0.7)), 0.5F);
    }
    return updater_.evaluate({}, ErrorMatrix::Identity().topLeftCorner<6, 6>(), {scan, {&above, 1}}, map_)
        .equations.information(kPos + 2, kPos + 2);
  };
  EXPECT_GT(information_of(20), 1.5 * information_of(1));
  EXPECT_LT(information_of(20), 1.0 / least_m2);
  EXPECT_LT(information_of(2000), 1.0 / least_m2);
  EXPECT_LT(information_of(2000), 1.5 * information_of(200));
}

TEST_F(ScanUpdate, AFloorAloneIsFlaggedAndLeavesTheUnseenDirectionsAlone) {
  map_room(true);
  const auto points = scan(2000, true);
  const FilterBelief belief = prior(0.05);
  const ScanUpdateResult result = update(belief, points);
  ASSERT_TRUE(result.updated);
  EXPECT_LT(result.translation_conditioning, 1e-3);
  EXPECT_NEAR(result.belief.state.odom_from_body.translation_m.z(), truth_.translation_m.z(), 0.005);
  EXPECT_GT(std::sqrt(result.belief.covariance(kPos, kPos)), 0.04);  // as little is known as before
  const Vector3d moved =
      result.belief.state.odom_from_body.translation_m - belief.state.odom_from_body.translation_m;
  EXPECT_LT(moved.head<2>().norm(), 0.02);
}

TEST_F(ScanUpdate, PeopleInFrontOfTheWallsDoNotMoveThePose) {
  map_room();
  auto points = scan(2000);
  test::Random random(9);
  for (int i = 0; i < 600; ++i) {  // three people close to the walls, within cells that hold a plane
    const Vector3d person = truth_.inverse() * Vector3d(-4.7 + 4.0 * (i % 3), 3.75, 1.0);
    points.push_back((person + random.vector(0.2)).cast<float>());
  }
  const ScanUpdateResult result = update(prior(0.05), points);
  ASSERT_TRUE(result.updated);
  EXPECT_LT(position_error(result), 0.006);
  EXPECT_LT(result.last.used, 2250);
}

TEST_F(ScanUpdate, CoastsWhereTooLittleMatches) {
  map_room();
  std::vector<Eigen::Vector3f> far(500, Eigen::Vector3f(0.0F, 0.0F, 60.0F));
  const FilterBelief belief = prior(0.05);
  const ScanUpdateResult result = update(belief, far);
  EXPECT_FALSE(result.updated);
  EXPECT_EQ(result.belief.covariance, belief.covariance);
  EXPECT_FALSE(update(belief, {}).updated);
}

TEST_F(ScanUpdate, TwoThreadsGiveTheSameBits) {
  map_room();
  const auto points = scan(3000);
  BlockLoop two(2);
  ScanUpdater with_two(ScanUpdateConfig{}, two);
  const FilterBelief belief = prior(0.1);
  const ScanView view{points, {&beam_, 1}};
  const ErrorMatrix one = update(belief, points).belief.covariance;
  EXPECT_EQ(with_two.run(belief, belief.state, view, map_).belief.covariance, one);
}

}  // namespace
}  // namespace edgesplat::tracking
