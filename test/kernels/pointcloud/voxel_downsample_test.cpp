// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/pointcloud/voxel_downsample.hpp"

#include "test/support/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace edgesplat::pointcloud {
namespace {

using testing::ElementsAre;

TEST(VoxelDownsample, KeepsTheFirstPointOfEachCell) {
  VoxelDownsampler downsampler;
  const std::vector<Eigen::Vector3f> points = {{0.1F, 0.1F, 0.1F}, {0.9F, 0.9F, 0.9F}, {1.1F, 0.1F, 0.1F}};
  EXPECT_THAT(downsampler.run(points, 1.0F), ElementsAre(0U, 2U));
}

TEST(VoxelDownsample, CellsBelowZeroAreAsWideAsOthers) {
  VoxelDownsampler downsampler;
  const std::vector<Eigen::Vector3f> points = {{0.1F, 0, 0}, {-0.1F, 0, 0}, {-0.9F, 0, 0}, {-1.1F, 0, 0}};
  EXPECT_THAT(downsampler.run(points, 1.0F), ElementsAre(0U, 1U, 3U));
}

TEST(VoxelDownsample, LeavesOutWhatIsNotFiniteOrAbsurdlyFar) {
  VoxelDownsampler downsampler;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<Eigen::Vector3f> points = {{nan, 0, 0}, {0, nan, 0},   {0, 0, nan},
                                               {0, inf, 0}, {1e30F, 0, 0}, {1, 2, 3}};
  EXPECT_THAT(downsampler.run(points, 0.5F), ElementsAre(5U));
}

TEST(VoxelDownsample, AnEmptyCloudStaysEmpty) {
  VoxelDownsampler downsampler;
  EXPECT_TRUE(downsampler.run({}, 0.5F).empty());
}

TEST(VoxelDownsample, AgreesWithASetOfCells) {
  test::Random random(4);
  std::vector<Eigen::Vector3f> points(5000);
  for (auto& point : points) point = random.vector(8.0).cast<float>();
  std::set<std::array<int, 3>> cells;
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Eigen::Array3i cell = (points[i] * (1.0F / 0.7F)).array().floor().cast<int>();
    if (cells.insert({cell.x(), cell.y(), cell.z()}).second) expected.push_back(i);
  }
  VoxelDownsampler downsampler;
  EXPECT_THAT(downsampler.run(points, 0.7F), testing::ElementsAreArray(expected));
}

}  // namespace
}  // namespace edgesplat::pointcloud
