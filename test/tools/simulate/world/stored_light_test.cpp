// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/stored_light.hpp"

#include <gtest/gtest.h>

namespace edgesplat::simulate {
namespace {

using Eigen::Vector3d;

/// A floor, a post on it and the sun in the east, 45 degrees up.
Scene yard() {
  Scene s;
  const auto grey = s.add(Material{});
  s.add_box({-10, -10, -1}, {10, 10, 0}, grey);
  s.add_box({-0.5, -0.5, 0}, {0.5, 0.5, 2}, grey);
  s.light.sun = Sun{Vector3d(1, 0, 1).normalized(), Rgb::Constant(0.8F)};
  s.light.ambient_up = Rgb::Constant(0.3F);
  s.light.texel_m = 0.1;
  return s;
}

TEST(Light, SunAndSkyAddUpInTheOpen) {
  const StaticScene still(yard());
  const Irradiance open = light_at(still, {6, 0, 0}, Vector3d::UnitZ());
  EXPECT_NEAR(open.total.x(), 0.3 + 0.8 * std::sqrt(0.5), 0.01);
  EXPECT_NEAR(open.sun_share, 0.8 * std::sqrt(0.5) / (0.3 + 0.8 * std::sqrt(0.5)), 0.01);
}

TEST(Light, APostThrowsAShadowAwayFromTheSun) {
  const StaticScene still(yard());
  EXPECT_EQ(light_at(still, {-1.5, 0, 0}, Vector3d::UnitZ()).sun_share, 0.0F);
  EXPECT_GT(light_at(still, {1.5, 0, 0}, Vector3d::UnitZ()).sun_share, 0.5F);
  EXPECT_GT(light_at(still, {-4.0, 0, 0}, Vector3d::UnitZ()).sun_share, 0.5F);  // beyond the shadow's tip
}

TEST(Light, CornersAreDarker) {
  Scene scene = yard();
  scene.light.sun.reset();
  const StaticScene still(std::move(scene));
  const float corner = light_at(still, {0.55, 0, 0}, Vector3d::UnitZ()).total.x();
  const float open = light_at(still, {5, 0, 0}, Vector3d::UnitZ()).total.x();
  EXPECT_LT(corner, 0.85F * open);
  EXPECT_GT(corner, 0.3F * open);
}

TEST(Light, ALampLightsWhatIsBelowItOnly) {
  Scene scene = yard();
  scene.light.sun.reset();
  scene.light.ambient_up = scene.light.ambient_down = Rgb::Zero();
  scene.light.lamps.push_back({{5, 0, 2}, {0.01, 0.01}, Rgb::Constant(2.0F)});
  const StaticScene still(std::move(scene));
  EXPECT_NEAR(light_at(still, {5, 0, 0}, Vector3d::UnitZ()).total.x(), 2.0 / 4.0, 0.01);
  EXPECT_EQ(light_at(still, {5, 0, 3}, Vector3d::UnitZ()).total.x(), 0.0F);
  EXPECT_EQ(light_at(still, {-3, 0, 0}, Vector3d::UnitZ()).total.x(), 0.0F);  // behind the post
}

TEST(StoredLight, AgreesWithTheLightOffShadowBorders) {
  const StaticScene still(yard());
  const StoredLight stored(still);
  constexpr std::uint32_t kFloorTop = 0 * kFacesPerPrimitive + 5;
  for (const Vector3d& p : {Vector3d(4.03, 2.21, 0), Vector3d(-7.7, 3.3, 0), Vector3d(-1.5, 0.1, 0)}) {
    const Irradiance exact = light_at(still, p, Vector3d::UnitZ());
    const Irradiance kept = stored.at(kFloorTop, {p.x() + 10.0, p.y() + 10.0});
    EXPECT_NEAR(kept.total.x(), exact.total.x(), 0.02);
    EXPECT_NEAR(kept.sun_share, exact.sun_share, 0.02);
    EXPECT_EQ(stored.at(kFloorTop, {p.x() + 10.0, p.y() + 10.0}).total, kept.total);  // from the store
  }
}

}  // namespace
}  // namespace edgesplat::simulate
