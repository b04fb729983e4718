// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/neighbour_grid.hpp"

#include "kernels/mapping/voxel_table.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace edgesplat::mapping {
namespace {

TEST(NeighbourGrid, AgreesWithAskingEveryPoint) {
  test::Random random(3);
  std::vector<Eigen::Vector3f> points(2000);
  for (auto& point : points) point = random.vector(1.0).cast<float>();
  const float edge_m = 0.2F;
  const NeighbourGrid grid(points, edge_m);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3f p = random.vector(1.1).cast<float>();
    std::vector<float> all;
    for (const auto& q : points) {
      if ((q - p).squaredNorm() <= edge_m * edge_m) all.push_back((q - p).squaredNorm());
    }
    std::sort(all.begin(), all.end());
    const Neighbours found = grid.nearest(p);
    ASSERT_EQ(found.count, std::min<std::size_t>(all.size(), Neighbours::kMost));
    for (std::size_t k = 0; k < found.count; ++k) {
      EXPECT_EQ(found.squared_m2[k], all[k]);
      EXPECT_EQ((points[found.index[k]] - p).squaredNorm(), all[k]);
    }
  }
}

TEST(NeighbourGrid, NoPointsNoNeighbours) {
  const NeighbourGrid grid({}, 0.1F);
  EXPECT_EQ(grid.nearest(Eigen::Vector3f::Zero()).count, 0U);
}

TEST(VoxelTable, NumbersCellsInTheOrderOfSight) {
  VoxelTable table;
  EXPECT_EQ(table.find(5), VoxelTable::kNone);
  for (std::uint64_t i = 0; i < 10000; ++i) EXPECT_EQ(table.find_or_add(i * 7919), i);
  for (std::uint64_t i = 0; i < 10000; ++i) EXPECT_EQ(table.find_or_add(i * 7919), i);
  EXPECT_EQ(table.find(3), VoxelTable::kNone);
  EXPECT_EQ(table.size(), 10000U);
}

}  // namespace
}  // namespace edgesplat::mapping
