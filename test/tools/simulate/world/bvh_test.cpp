// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/bvh.hpp"

#include "test/tools/simulate/world/random_rays.hpp"
#include "tools/simulate/world/places.hpp"
#include "tools/simulate/world/static_scene.hpp"

#include <gtest/gtest.h>

namespace edgesplat::simulate {
namespace {

using Eigen::Vector3d;

double brute_force(const Scene& scene, const Vector3d& origin, const Vector3d& direction) {
  double nearest = kFarthestRange_m;
  for (const Primitive& p : scene.primitives)
    nearest = intersect(p, origin, direction, kNearestRange_m, nearest);
  return nearest;
}

void compare(Scene scene, std::uint64_t seed, int count) {
  const StaticScene still(std::move(scene));
  RandomRays rays(seed);
  int hits = 0;
  for (int i = 0; i < count; ++i) {
    const auto& waypoints = still.scene().path.waypoints_m;
    const auto place = static_cast<std::size_t>(rays.uniform(0.0, static_cast<double>(waypoints.size())));
    const Vector3d origin = waypoints[std::min(place, waypoints.size() - 1)];
    // Every fourth ray runs along an axis, where a division by zero lurks.
    const Vector3d direction =
        i % 4 == 0 ? Vector3d(Vector3d::Unit(i / 4 % 3) * (i % 8 == 0 ? 1 : -1)) : rays.direction();
    const double expected = brute_force(still.scene(), origin, direction);
    const auto found = still.nearest(origin, direction, kNearestRange_m, kFarthestRange_m);
    EXPECT_EQ(found.has_value(), expected < kFarthestRange_m);
    if (found) {
      EXPECT_EQ(found->range_m, expected);
    }
    EXPECT_EQ(still.blocked(origin, direction, kNearestRange_m, 3.0), expected < 3.0);
    hits += found.has_value() ? 1 : 0;
  }
  EXPECT_GT(hits, count / 10);
}

TEST(Bvh, FindsWhatBruteForceFindsInACorridor) {
  compare(make_corridor(1), 5, 4000);
}

TEST(Bvh, FindsWhatBruteForceFindsInAStreet) {
  compare(make_street(2), 6, 1000);
}

TEST(Bvh, HoldsNothingOrOneThing) {
  const Bvh none(std::vector<Bounds>{});
  EXPECT_EQ(none.walk({0, 0, 0}, {1, 0, 0}, 9.0, [](std::uint32_t, double) { return 0.0; }), 9.0);
  const Bvh one(std::vector<Bounds>{{Vector3d(1, -1, -1), Vector3d(2, 1, 1)}});
  int asked = 0;
  one.walk({0, 0, 0}, {1, 0, 0}, 9.0, [&](std::uint32_t, double to_m) { return ++asked, to_m; });
  one.walk({0, 0, 0}, {-1, 0, 0}, 9.0, [&](std::uint32_t, double to_m) { return ++asked, to_m; });
  EXPECT_EQ(asked, 1);
}

TEST(Bvh, SurvivesManyEqualBoxes) {
  const Bvh same(std::vector<Bounds>(500, Bounds{Vector3d(1, -1, -1), Vector3d(2, 1, 1)}));
  int asked = 0;
  same.walk({0, 0, 0}, {1, 0, 0}, 9.0, [&](std::uint32_t, double to_m) { return ++asked, to_m; });
  EXPECT_EQ(asked, 500);
}

}  // namespace
}  // namespace edgesplat::simulate
