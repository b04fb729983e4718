// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/visual_normal.hpp"

#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace edgesplat::tracking {
namespace {

/// A ray's way over a plane through its end when its direction changes by `change`.
Eigen::Vector3f step_on(const Eigen::Vector3f& normal, const Eigen::Vector3f& ray,
                        const Eigen::Vector3f& change) {
  return change - normal.dot(change) / normal.dot(ray) * ray;
}

Eigen::Vector3f tilted(double degrees) {
  const double angle = degrees / 180.0 * std::numbers::pi;
  return Eigen::Vector3d(std::sin(angle), 0.0, std::cos(angle)).cast<float>();
}

TEST(TurnPlane, GivesTheStepsThatALookAtTheOtherPlaneHas) {
  const Eigen::Vector3f ray(0.6F, -0.2F, -3.0F);
  const Eigen::Vector3f right(0.01F, 0.0F, 0.001F), down(0.0F, 0.01F, 0.002F);
  VisualObservation observation;
  observation.from_camera_m = ray;
  observation.right_m = step_on(tilted(20.0), ray, right);
  observation.down_m = step_on(tilted(20.0), ray, down);
  // The camera looks straight down: the depth is -z.
  const auto growth = [&ray](const VisualObservation& look) {
    return Eigen::Vector2f(look.right_m.z() / ray.z(), look.down_m.z() / ray.z());
  };
  observation.growth = growth(observation);
  turn_plane(observation, tilted(-15.0));
  EXPECT_TRUE(observation.growth.isApprox(growth(observation), 1e-5F));
  EXPECT_TRUE(observation.right_m.isApprox(step_on(tilted(-15.0), ray, right), 1e-5F));
  EXPECT_TRUE(observation.down_m.isApprox(step_on(tilted(-15.0), ray, down), 1e-5F));
}

class RefineNormal : public testing::Test {
 protected:
  /// The floor z = 0, measured to a centimetre, and a point on it, seen once from 2 m above.
  RefineNormal() {
    test::Random random(1);
    for (int i = 0; i < 500; ++i) {
      MapPoint point;
      point.p_in_odom_m = {random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0),
                           0.2 + 0.005 * random.normal()};
      point.covariance_m2 << 2.5e-5F, 0.0F, 0.0F, 2.5e-5F, 0.0F, 2.5e-5F;
      point.pose_covariance_m2.setZero();
      planes.insert(point, {0.0, 0.0, 2.0});
    }
  }

  std::uint32_t add(const Eigen::Vector3d& at_m, const Eigen::Vector3f& normal) {
    VisualPoint point;
    point.p_in_odom_m = at_m;
    point.normal = normal;
    const std::uint32_t index = map.add(point);
    VisualObservation look;
    look.from_camera_m = {0.5F, 0.0F, -2.0F};
    look.right_m = step_on(normal, look.from_camera_m, right);
    look.down_m = step_on(normal, look.from_camera_m, down);
    map.observe(index, look);
    refine_normal(map, map.point(index), planes);
    return index;
  }

  const Eigen::Vector3f right{0.01F, 0.0F, 0.0F}, down{0.0F, -0.01F, 0.0F};
  PlaneMap planes{PlaneMapConfig{}};
  VisualMap map{1U << 20U};
};

TEST_F(RefineNormal, TakesThePlanesAndTurnsTheLooks) {
  const VisualPoint& point = map.point(add({0.3, 0.3, 0.2}, tilted(8.0)));
  EXPECT_GT(point.normal.z(), 0.9999F);
  const VisualObservation& look = map.observation(point.observations[0]);
  EXPECT_LT((look.right_m - step_on(point.normal, look.from_camera_m, right)).norm(), 1e-6F);
  EXPECT_LT((look.down_m - step_on(point.normal, look.from_camera_m, down)).norm(), 1e-6F);
}

TEST_F(RefineNormal, KeepsTheSideThatWasSeen) {
  VisualPoint below;
  below.p_in_odom_m = {0.3, 0.3, 0.2};
  below.normal = -tilted(5.0);
  const std::uint32_t index = map.add(below);
  refine_normal(map, map.point(index), planes);
  EXPECT_LT(map.point(index).normal.z(), -0.9999F);
}

TEST_F(RefineNormal, LeavesWhatIsAnotherPlaneOrNone) {
  EXPECT_TRUE(map.point(add({0.3, 0.3, 0.2}, tilted(25.0))).normal.isApprox(tilted(25.0)));
  EXPECT_TRUE(map.point(add({0.3, 0.3, 0.28}, tilted(5.0))).normal.isApprox(tilted(5.0)));
  EXPECT_TRUE(map.point(add({30.0, 0.3, 0.2}, tilted(5.0))).normal.isApprox(tilted(5.0)));
}

}  // namespace
}  // namespace edgesplat::tracking
