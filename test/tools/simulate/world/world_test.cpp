// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world.hpp"

#include "test/tools/simulate/world/random_rays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace edgesplat::simulate {
namespace {

using Eigen::Vector3d;

std::unique_ptr<World> world(const std::string& name, int pedestrians = 0, std::uint64_t seed = 1,
                             int cars = 0) {
  auto made = World::create({name, pedestrians, cars, seed});
  EXPECT_TRUE(made.has_value());
  return made ? *std::move(made) : nullptr;
}

Vector3d somewhere_on(const World::Path& path, RandomRays& rays) {
  const auto at = static_cast<std::size_t>(rays.uniform(0.0, static_cast<double>(path.waypoints_m.size())));
  return path.waypoints_m[std::min(at, path.waypoints_m.size() - 1)];
}

/// Range of 2000 rays from the path, at different times; 0 for none.
std::vector<double> ranges(const World& w, Visibility visibility, std::uint64_t seed = 3) {
  RandomRays rays(seed);
  const World::Path path = w.path();
  std::vector<double> out;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d origin = somewhere_on(path, rays), direction = rays.direction();
    const auto hit = w.cast({origin, direction, rays.uniform(0, 60)}, visibility);
    out.push_back(hit ? hit->range_m : 0.0);
  }
  return out;
}

TEST(World, RefusesUnknownNamesAndCrowdsBeyondTheLimit) {
  for (const WorldConfig& bad : {WorldConfig{"moon", 0, 0, 1}, WorldConfig{"corridor", 101, 0, 1},
                                 WorldConfig{"corridor", -1, 0, 1}, WorldConfig{"street", 0, 51, 1}}) {
    const auto made = World::create(bad);
    ASSERT_FALSE(made.has_value());
    EXPECT_EQ(made.error().code, Errc::kInvalidConfig);
  }
}

class EveryWorld : public testing::TestWithParam<std::string> {};

TEST_P(EveryWorld, IsDecidedByItsSeed) {
  const auto first = world(GetParam(), 12, 5, 5), again = world(GetParam(), 12, 5, 5),
             other = world(GetParam(), 12, 6, 5);
  EXPECT_EQ(ranges(*first, Visibility::kEverything), ranges(*again, Visibility::kEverything));
  EXPECT_NE(ranges(*first, Visibility::kEverything), ranges(*other, Visibility::kEverything));
}

TEST_P(EveryWorld, PathKeepsItsDistanceFromEverythingStatic) {
  const auto w = world(GetParam());
  const World::Path path = w->path();
  ASSERT_GE(path.waypoints_m.size(), 10U);
  EXPECT_GE(path.speed_mps, 1.0);
  EXPECT_LE(path.speed_mps, 1.5);
  for (const Vector3d& p : path.waypoints_m) {
    for (int k = 0; k < 72; ++k) {
      const double angle = k * 5.0 * 3.14159265 / 180.0;
      for (const double up : {GetParam() == "stairs" ? 0.2 : -0.35, 0.0, 0.4}) {
        const auto hit = w->cast({p + Vector3d(0, 0, up), {std::cos(angle), std::sin(angle), 0.0}, 0.0},
                                 Visibility::kStaticOnly);
        if (hit) {
          EXPECT_GT(hit->range_m, 0.6) << "near " << p.transpose();
        }
      }
    }
    const auto ground = w->cast({p, {0, 0, -1}, 0.0}, Visibility::kStaticOnly);
    ASSERT_TRUE(ground);
    EXPECT_NEAR(ground->range_m, 0.6, GetParam() == "stairs" ? 0.12 : 0.02);
  }
}

TEST_P(EveryWorld, PathIsSmooth) {
  const World::Path path = world(GetParam())->path();
  const std::size_t n = path.waypoints_m.size();
  for (std::size_t i = 1; i + 1 < n + (path.closed ? 1 : 0); ++i) {
    const Vector3d in = path.waypoints_m[i % n] - path.waypoints_m[i - 1];
    const Vector3d out = path.waypoints_m[(i + 1) % n] - path.waypoints_m[i % n];
    EXPECT_GT(in.normalized().dot(out.normalized()), std::cos(0.35)) << "at " << i;
    EXPECT_LT(in.norm(), 1.1);
  }
  if (path.closed) {
    EXPECT_LT((path.waypoints_m.front() - path.waypoints_m.back()).norm(), 1.0);
  }
}

TEST_P(EveryWorld, HitsAreSound) {
  const auto w = world(GetParam(), 10, 1, 5);
  RandomRays rays(9);
  const World::Path path = w->path();
  for (int i = 0; i < 3000; ++i) {
    const Ray ray{somewhere_on(path, rays), rays.direction(), rays.uniform(0, 30)};
    const auto hit = w->cast(ray, Visibility::kEverything);
    if (!hit) continue;
    EXPECT_GE(hit->range_m, 0.05);
    EXPECT_LE(hit->range_m, 200.0);
    EXPECT_NEAR(hit->normal.norm(), 1.0, 1e-9);
    EXPECT_LE(hit->normal.dot(ray.direction), 1e-9);
    EXPECT_GE(hit->reflectivity, 0.05F);
    EXPECT_LE(hit->reflectivity, 0.9F);
    EXPECT_LE(hit->mover, 15);
  }
}

TEST_P(EveryWorld, LightFitsIntoThePicture) {
  // Nothing saturates, lamps, windows and sky included, and a place is neither night nor glare.
  const auto w = world(GetParam(), 10, 1, 5);
  RandomRays rays(10);
  const World::Path path = w->path();
  double sum = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray{somewhere_on(path, rays), rays.direction(), 1.0};
    const auto hit = w->cast(ray, Visibility::kEverything);
    const Eigen::Vector3f light = w->radiance(ray, hit, 0.01, Visibility::kEverything);
    EXPECT_TRUE((light.array() >= 0.0F).all() && (light.array() <= 1.0F).all()) << light.transpose();
    sum += static_cast<double>(light.mean());
  }
  EXPECT_GT(sum / 2000, 0.08);
  EXPECT_LT(sum / 2000, 0.6);
}

TEST_P(EveryWorld, MoversAreAbsentFromTheStaticView) {
  const auto empty = world(GetParam(), 0, 1, 0), full = world(GetParam(), 40, 1, 20);
  EXPECT_EQ(ranges(*empty, Visibility::kEverything), ranges(*full, Visibility::kStaticOnly));
  EXPECT_NE(ranges(*full, Visibility::kEverything), ranges(*full, Visibility::kStaticOnly));
}

TEST_P(EveryWorld, FrozenMoversStandWhereTheMovingOnesAre) {
  const auto w = world(GetParam(), 30, 1, 10);
  const auto frozen = w->frozen_at(7.25);
  ASSERT_NE(frozen, nullptr);
  RandomRays rays(11);
  const World::Path path = w->path();
  int movers = 0;
  for (int i = 0; i < 4000; ++i) {
    Ray ray{somewhere_on(path, rays), rays.direction(), 7.25};
    ray.direction.z() *= 0.2;
    ray.direction.normalize();
    const auto moving = w->cast(ray, Visibility::kEverything),
               still = frozen->cast(ray, Visibility::kEverything);
    ASSERT_EQ(moving.has_value(), still.has_value());
    if (!moving) continue;
    EXPECT_EQ(moving->range_m, still->range_m);
    EXPECT_EQ(moving->mover, still->mover);
    EXPECT_EQ(w->radiance(ray, moving, 0.01, Visibility::kEverything),
              frozen->radiance(ray, still, 0.01, Visibility::kEverything));
    movers += moving->mover != 0 ? 1 : 0;
  }
  EXPECT_GT(movers, 20);
}

TEST_P(EveryWorld, ShadeIsTheOnlyDifferenceOnStaticSurfaces) {
  const auto w = world(GetParam(), 40, 1, 20)->frozen_at(3.0) ? world(GetParam(), 40, 1, 20) : nullptr;
  ASSERT_NE(w, nullptr);
  RandomRays rays(12);
  const World::Path path = w->path();
  int shaded = 0, untouched = 0;
  for (int i = 0; i < 4000; ++i) {
    const Ray ray{somewhere_on(path, rays), rays.direction(), 3.0};
    const auto hit = w->cast(ray, Visibility::kEverything);
    if (!hit || hit->mover != 0) continue;
    const float shade = w->mover_shade(ray, *hit);
    EXPECT_GE(shade, 0.0F);
    EXPECT_LE(shade, 1.0F);
    const Eigen::Vector3f clean = w->radiance(ray, hit, 0.02, Visibility::kStaticOnly);
    EXPECT_TRUE(w->radiance(ray, hit, 0.02, Visibility::kEverything).isApprox(shade * clean, 1e-5F));
    (shade < 1.0F ? shaded : untouched) += 1;
  }
  EXPECT_GT(shaded, 30);
  EXPECT_GT(untouched, 300);
}

INSTANTIATE_TEST_SUITE_P(Worlds, EveryWorld,
                         testing::Values("corridor", "bare", "loop", "stairs", "street", "tunnel", "square"),
                         [](const auto& place) { return place.param; });

TEST(World, OnlyCorridorsAreClosed) {
  for (const char* name : {"corridor", "bare", "loop", "stairs", "street", "tunnel", "square"}) {
    const std::string_view place = name;
    EXPECT_EQ(world(name)->path().closed, place == "corridor" || place == "bare" || place == "loop");
  }
}

double length_m(const World::Path& path) {
  double length = path.closed ? (path.waypoints_m.front() - path.waypoints_m.back()).norm() : 0.0;
  for (std::size_t i = 1; i < path.waypoints_m.size(); ++i)
    length += (path.waypoints_m[i] - path.waypoints_m[i - 1]).norm();
  return length;
}

TEST(World, TheLoopIs300MetresAround) {
  EXPECT_NEAR(length_m(world("loop")->path()), 300.0, 4.0);
}

TEST(World, StairsClimbTwoStoreys) {
  const World::Path path = world("stairs")->path();
  EXPECT_NEAR(path.waypoints_m.back().z() - path.waypoints_m.front().z(), 6.8, 0.01);
  for (std::size_t i = 1; i < path.waypoints_m.size(); ++i)
    EXPECT_GE(path.waypoints_m[i].z(), path.waypoints_m[i - 1].z());
}

TEST(World, ABareCorridorHasTheSameWallsAndNoTexture) {
  const auto bare = world("bare"), furnished = world("corridor");
  RandomRays rays(14);
  int same = 0, edges = 0, seen = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d origin = somewhere_on(bare->path(), rays), direction = rays.direction();
    const auto hit = bare->cast({origin, direction, 0}, Visibility::kStaticOnly);
    const auto with_furniture = furnished->cast({origin, direction, 0}, Visibility::kStaticOnly);
    ASSERT_TRUE(hit && with_furniture);
    EXPECT_GT(hit->range_m, with_furniture->range_m - 0.01);
    same += std::abs(hit->range_m - with_furniture->range_m) < 0.05 ? 1 : 0;
    // A finger's breadth beside, the light is the same.
    const Vector3d beside = (direction + Vector3d(0.01, 0.01, 0.01)).normalized();
    const auto next = bare->cast({origin, beside, 0}, Visibility::kStaticOnly);
    if (hit->range_m > 4.0 || !next || next->surface != hit->surface) continue;
    const auto at = [&](const Vector3d& towards, const std::optional<Hit>& where) {
      return bare->radiance({origin, towards, 0}, where, 0.01, Visibility::kStaticOnly).mean();
    };
    ++seen;
    edges += std::abs(at(direction, hit) - at(beside, next)) > 0.02F ? 1 : 0;
  }
  EXPECT_GT(same, 700);
  EXPECT_LT(edges * 20, seen);
}

TEST(World, ATunnelLooksTheSameAllAlongToALidar) {
  const auto w = world("tunnel");
  RandomRays rays(13);
  for (int i = 0; i < 500; ++i) {
    const Vector3d direction = rays.direction();
    if (direction.z() > 0.9) continue;  // the lamps stand 3 cm proud of the crown
    const auto here = w->cast({{40, 0, 0.8}, direction, 0}, Visibility::kStaticOnly);
    const auto there = w->cast({{47.3, 0, 0.8}, direction, 0}, Visibility::kStaticOnly);
    if (here && there && here->range_m < 50.0) {
      EXPECT_NEAR(here->range_m, there->range_m, 0.05);
    }
  }
}

}  // namespace
}  // namespace edgesplat::simulate
