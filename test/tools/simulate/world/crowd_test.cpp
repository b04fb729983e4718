// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/crowd.hpp"

#include "tools/simulate/route.hpp"
#include "tools/simulate/world/places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

namespace edgesplat::simulate {
namespace {

using Eigen::Vector3d;

Scene place(const std::string& name) {
  return name == "corridor" ? make_corridor(1)
         : name == "street" ? make_street(1)
         : name == "tunnel" ? make_tunnel(1)
                            : make_square(1);
}

/// Distance from above between a point and the route that the robot drives.
double distance_m(const Route& route, const Vector3d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (double s = 0.0; s < route.length_m(); s += 0.05)
    nearest = std::min(nearest, (route.position_m(s) - p).head<2>().norm());
  return nearest;
}

class EveryPlace : public testing::TestWithParam<std::string> {};

TEST_P(EveryPlace, MoversKeepHalfAMetreFromTheRobotsWay) {
  const Scene scene = place(GetParam());
  const Crowd crowd(scene, {GetParam(), 8, 4, 1});
  const auto route = Route::create(scene.path);
  ASSERT_TRUE(route.has_value());
  for (double t = 0.0; t < 40.0; t += 4.7) {
    for (std::size_t i = 0; i < crowd.size(); ++i) {
      const Stance stance = crowd.stance(i, t);
      EXPECT_GT(distance_m(*route, stance.foot_m), 0.72) << "mover " << i << " at " << t << " s";
      // The trunk, arms aside.
      EXPECT_GT(distance_m(*route, stance.foot_m) - 0.11 * crowd.body(i).height_m, 0.5);
    }
  }
}

TEST_P(EveryPlace, MoversNeverWalkThroughEachOther) {
  const Scene scene = place(GetParam());
  const Crowd crowd(scene, {GetParam(), 24, 10, 1});
  for (double t = 0.0; t < 60.0; t += 1.3) {
    for (std::size_t i = 0; i < crowd.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const double apart = (crowd.stance(i, t).foot_m - crowd.stance(k, t).foot_m).head<2>().norm();
        EXPECT_GT(apart, 0.9) << i << " and " << k << " at " << t;
      }
    }
  }
}

TEST_P(EveryPlace, PartsStayInTheirBallCylinderAndOnTheGround) {
  const Scene scene = place(GetParam());
  const Crowd crowd(scene, {GetParam(), 20, 10, 3});
  for (double t = 0.0; t < 3.0; t += 0.07) {
    for (std::size_t i = 0; i < crowd.size(); ++i) {
      const MoverBall ball = crowd.ball(i, t);
      for (const Primitive& part : crowd.pose(i, crowd.stance(i, t))) {
        const Bounds box = bounds(part);
        const Vector3d middle = (box.lo_m + box.hi_m) / 2.0 - ball.centre_m;
        EXPECT_LT(middle.norm() + part.half_m.minCoeff(), ball.radius_m);
        EXPECT_LT(middle.head<2>().norm() + part.half_m.minCoeff(), ball.width_m);
        EXPECT_GT(box.lo_m.z(), crowd.stance(i, t).foot_m.z() - 0.03);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Places, EveryPlace, testing::Values("corridor", "street", "tunnel", "square"),
                         [](const auto& place) { return place.param; });

TEST(Crowd, MovesAtItsLanesSpeed) {
  const Scene scene = make_corridor(1);
  const Crowd crowd(scene, {"corridor", 2, 0, 1});
  for (std::size_t i = 0; i < 2; ++i) {
    const double moved = (crowd.stance(i, 5.01).foot_m - crowd.stance(i, 5.0).foot_m).norm();
    EXPECT_NEAR(moved / 0.01, std::abs(scene.footways[i].speed_mps), 0.15);
    EXPECT_GT((crowd.stance(i, 5.01).foot_m - crowd.stance(i, 5.0).foot_m)
                  .head<2>()
                  .dot(crowd.stance(i, 5.0).forward),
              0.0);
  }
}

TEST(Crowd, SwingsItsLimbs) {
  const Scene scene = make_square(1);
  const Crowd crowd(scene, {"square", 1, 0, 1});
  const Stance now = crowd.stance(0, 2.0), soon = crowd.stance(0, 2.3);
  const Vector3d knee_now = crowd.pose(0, now)[1].centre_m - now.foot_m;
  const Vector3d knee_soon = crowd.pose(0, soon)[1].centre_m - soon.foot_m;
  EXPECT_GT((knee_now - knee_soon).norm(), 0.05);
}

}  // namespace
}  // namespace edgesplat::simulate
