// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/pointcloud/voxel_downsample.hpp"

#include "test/support/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <span>

namespace edgesplat::pointcloud {
namespace {

using testing::ElementsAre;

TEST(VoxelDownsample, KeepsOnePointOfEachCell) {
  VoxelDownsampler downsampler;
  const std::vector<Eigen::Vector3f> points = {{0.1F, 0.1F, 0.1F}, {1.1F, 0.1F, 0.1F}, {0.9F, 0.9F, 0.9F}};
  EXPECT_THAT(downsampler.run(points, 1.0F), ElementsAre(testing::AnyOf(0U, 2U), 1U));
}

TEST(VoxelDownsample, KeepsTheSamePointsEveryTime) {
  test::Random random(5);
  std::vector<Eigen::Vector3f> points(5000);
  for (auto& point : points) point = random.vector(2.0).cast<float>();
  VoxelDownsampler used, fresh;
  used.run(std::span(points).first(100), 0.1F);
  const auto once = used.run(points, 0.5F);
  EXPECT_THAT(fresh.run(points, 0.5F), testing::ElementsAreArray(once));
}

// 1000 cells of eight points each: the kept ones' mean rank is 3.5 with a standard error of 2.29 /
// sqrt(1000).
TEST(VoxelDownsample, NoPlaceInTheOrderIsPreferred) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 8000; ++i) points.emplace_back(static_cast<float>(i / 8) + 0.5F, 0.5F, 0.5F);
  VoxelDownsampler downsampler;
  double sum = 0.0;
  for (const std::uint32_t kept : downsampler.run(points, 1.0F)) sum += kept % 8U;
  EXPECT_NEAR(sum / 1000.0, 3.5, 4.0 * 2.29 / std::sqrt(1000.0));
}

// A LiDAR turns between two walls; its bearings are noisy. The first point of every cell would be one whose
// noise points the way it turns: by 0.4 sigma here.
TEST(VoxelDownsample, WhatATurningLidarKeepsIsNotTurned) {
  constexpr double kSigma_rad = 2.6e-3;
  constexpr int kRays = 40000;
  test::Random random(6);
  std::vector<Eigen::Vector3f> points;
  std::vector<double> noise_rad;
  for (int i = 0; i < kRays; ++i) {
    const double azimuth = 2.0 * std::numbers::pi * i / kRays;
    const double range_m = std::min(30.0, 1.5 / std::max(1e-9, std::abs(std::sin(azimuth))));
    noise_rad.push_back(kSigma_rad * random.normal());
    const double measured = azimuth + noise_rad.back();
    points.push_back(
        Eigen::Vector3d(range_m * std::cos(measured), range_m * std::sin(measured), 1.0).cast<float>());
  }
  VoxelDownsampler downsampler;
  const auto kept = downsampler.run(points, 0.2F);
  double sum_rad = 0.0;
  for (const std::uint32_t i : kept) sum_rad += noise_rad[i];
  const double count = static_cast<double>(kept.size());
  EXPECT_GT(count, 300);
  EXPECT_NEAR(sum_rad / count, 0.0, 3.0 * kSigma_rad / std::sqrt(count));
}

TEST(VoxelDownsample, CellsBelowZeroAreAsWideAsOthers) {
  VoxelDownsampler downsampler;
  const std::vector<Eigen::Vector3f> points = {{0.1F, 0, 0}, {-0.1F, 0, 0}, {-0.9F, 0, 0}, {-1.1F, 0, 0}};
  EXPECT_THAT(downsampler.run(points, 1.0F), ElementsAre(0U, testing::AnyOf(1U, 2U), 3U));
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
  const auto cell_of = [](const Eigen::Vector3f& point) {
    const Eigen::Array3i cell = (point * (1.0F / 0.7F)).array().floor().cast<int>();
    return std::array<int, 3>{cell.x(), cell.y(), cell.z()};
  };
  std::set<std::array<int, 3>> expected, seen;
  for (const auto& point : points) expected.insert(cell_of(point));
  VoxelDownsampler downsampler;
  const auto kept = downsampler.run(points, 0.7F);
  for (const std::uint32_t i : kept) seen.insert(cell_of(points[i]));
  EXPECT_EQ(seen, expected);
  EXPECT_EQ(kept.size(), expected.size());
}

}  // namespace
}  // namespace edgesplat::pointcloud
