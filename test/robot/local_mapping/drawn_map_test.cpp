// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/local_mapping/drawn_map.hpp"

#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

namespace edgesplat::local_mapping {
namespace {

using Cloud = gaussian::GaussianCloud;

std::shared_ptr<const Cloud> cloud(std::size_t count, std::uint64_t seed, int sh_degree = 0) {
  return std::make_shared<const Cloud>(test::random_gaussians(count, seed, sh_degree));
}

TEST(DrawnMap, IsEmptyAtFirst) {
  EXPECT_EQ(DrawnMap().snapshot()->size(), 0U);
}

TEST(DrawnMap, OnePartAloneIsDrawnAsItIs) {
  DrawnMap drawn;
  const auto own = cloud(10, 1);
  drawn.set_provisional(own);
  EXPECT_EQ(drawn.snapshot(), own);
  drawn.set_provisional(std::make_shared<const Cloud>());
  const auto server = cloud(20, 2);
  drawn.set_resident(server, {});
  EXPECT_EQ(drawn.snapshot(), server);
}

TEST(DrawnMap, BothPartsAreDrawnOnce) {
  DrawnMap drawn;
  const auto server = cloud(20, 2, 1);
  const auto own = cloud(10, 1);
  drawn.set_resident(server, {});
  drawn.set_provisional(own);
  const auto both = drawn.snapshot();
  ASSERT_TRUE(both->consistent());
  ASSERT_EQ(both->size(), 30U);
  EXPECT_EQ(both->sh_degree, 1);
  EXPECT_EQ(both->means_m[3 * 20], own->means_m[0]);
  EXPECT_EQ(both->sh[12 * 20], own->sh[0]);
  EXPECT_EQ(both->sh[12 * 20 + 3], 0.0F);
  EXPECT_EQ(both->sh[12], server->sh[12]);
  drawn.set_resident(server, {});
  EXPECT_EQ(drawn.snapshot(), both);  // nothing changed: nothing made anew
}

TEST(DrawnMap, ACorrectionMovesTheRobotsOwnAlone) {
  DrawnMap drawn;
  const auto server = cloud(5, 2);
  const auto own = cloud(5, 1);
  drawn.set_provisional(own);
  drawn.set_resident(server, {});
  map::MapFromOdom correction;
  correction.version = 1;
  correction.map_from_odom.translation_m = {1.0, 2.0, 3.0};
  correction.map_from_odom.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  drawn.set_resident(server, correction);
  const auto both = drawn.snapshot();
  ASSERT_EQ(both->size(), 10U);
  for (int k = 0; k < 15; ++k)
    EXPECT_EQ(both->means_m[static_cast<std::size_t>(k)], server->means_m[static_cast<std::size_t>(k)]);
  const Eigen::Vector3d before(own->means_m[3], own->means_m[4], own->means_m[5]);
  const Eigen::Vector3d after = correction.map_from_odom * before;
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(both->means_m[3 * 6 + k], after[static_cast<Eigen::Index>(k)], 1e-4);
  // What comes later is moved too, and back again without the correction's effect on the odometry's frame.
  drawn.set_provisional(own);
  EXPECT_EQ(drawn.snapshot()->means_m, both->means_m);
  const auto back = moved(moved(own, correction.map_from_odom), correction.map_from_odom.inverse());
  for (std::size_t i = 0; i < back->quats_xyzw.size(); ++i)
    EXPECT_NEAR(std::abs(back->quats_xyzw[i]), std::abs(own->quats_xyzw[i]), 1e-5);
}

TEST(DrawnMap, IsPlacedByTheCorrectionThatItWasPutTogetherWith) {
  DrawnMap drawn;
  EXPECT_TRUE(drawn.placed().map_from_odom.matrix() == geometry::RigidTransform::identity().matrix());
  map::MapFromOdom correction;
  correction.version = 1;
  correction.map_from_odom.translation_m = {0.5, 0.0, -0.25};
  drawn.set_resident(cloud(5, 2), correction);
  const DrawnMap::Placed placed = drawn.placed();
  EXPECT_EQ(placed.in_map, drawn.snapshot());
  EXPECT_EQ(placed.map_from_odom.translation_m, correction.map_from_odom.translation_m);
}

}  // namespace
}  // namespace edgesplat::local_mapping
